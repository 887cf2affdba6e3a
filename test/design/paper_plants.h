#pragma once

#include <string>

#include "certificate/certificate.h"
#include "design/certify.h"
#include "design/packing.h"
#include "design/synthesis.h"
#include "design/workers.h"

namespace sampled_data_observers::test {

/// ẋ = A x, y = C x, sampled T1 to T2 apart.
inline CertificateSubject linear_subject(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C,
                                         double T1, double T2) {
  const Eigen::Index n = A.rows();
  CertificateSubject subject;
  ModeMatrices mode;
  mode.A = A;
  mode.C = C;
  mode.C_c.resize(0, n);
  mode.C_d.resize(0, n);
  subject.plant.modes = {mode};
  for (Eigen::Index i = 1; i <= n; ++i) {
    subject.plant.state_names.push_back("x" + std::to_string(i));
  }
  if (C.rows() > 0) subject.plant.sampled = {{"output", 0, 0, C.rows()}};
  subject.plant.G.resize(n, 0);
  subject.plant.S.resize(0, n);
  subject.plant.N.resize(n, 0);
  subject.plant.C_p.resize(0, n);
  subject.T1 = T1;
  subject.T2 = T2;
  return subject;
}

/// ferrante2016, example 2, (44): two masses, and the bias of the sensor as fifth state.
inline CertificateSubject mass_spring(double T1, double T2) {
  Eigen::MatrixXd A(5, 5);
  A << 0, 0, 1, 0, 0,   //
      0, 0, 0, 1, 0,    //
      -2, 1, -1, 0, 0,  //
      2, -2, 0, -2, 0,  //
      0, 0, 0, 0, 0;
  Eigen::MatrixXd C(1, 5);
  C << 1, 0, 0, 0, 1;
  return linear_subject(A, C, T1, T2);
}

/// sferlazza2019, (66).
inline CertificateSubject aircraft(double T1, double T2) {
  Eigen::MatrixXd A(3, 3);
  A << -0.02, -1.4, 9.8,  //
      -0.01, -0.4, 0,     //
      0, 1, 0;
  Eigen::MatrixXd C(1, 3);
  C << 1, 0, 1;
  return linear_subject(A, C, T1, T2);
}

/// The design by a method of a plant, with what was asked for.
inline Design design_by(const char* method, const CertificateSubject& subject,
                        const Parameters& given = {}, Objective objective = Objective::kFeasible) {
  DesignProblem problem;
  problem.subject = subject;
  problem.given = given;
  problem.objective = objective;
  SynthesisOptions options;
  options.time_limit = 300.0;  // under sanitizers an attempt takes long
  options.jobs = 2;
  return synthesize(*find_design_method(method), problem, options);
}

/// The proof that certify_here() finds for given gains and parameters; empty where it finds none.
inline NamedMatrices proof_for_gains(const char* theorem_name, const CertificateSubject& subject,
                                     const NamedMatrices& fixed) {
  const Theorem& theorem = *find_theorem(theorem_name);
  const auto task = [&](std::size_t) {
    const DesignCandidate candidate = certify_here(theorem, subject, fixed, Objective::kFeasible);
    Packer packer;
    packer.add(candidate.is_verified() ? candidate.values : NamedMatrices());
    return packer.bytes();
  };
  const WorkerOutcome outcome = run_in_workers(1, task, WorkerOptions()).front();
  if (outcome.status != WorkerOutcome::Status::kDone) return {};
  return Unpacker(outcome.result).matrices();
}

/// What synthesize() says of a design that can't be made; empty where it can.
inline std::string refusal(const char* method, const CertificateSubject& subject,
                           const Parameters& given = {},
                           Objective objective = Objective::kFeasible) {
  try {
    design_by(method, subject, given, objective);
  } catch (const DesignError& error) {
    return error.what();
  }
  return "";
}

}  // namespace sampled_data_observers::test
