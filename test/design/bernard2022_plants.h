#pragma once

#include <utility>

#include "design/certified.h"
#include "design/synthesis.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {

// Plants of bernard2022, and designs for them.

inline CertificateSubject jumping(const Eigen::MatrixXd& A, const Eigen::MatrixXd& A_d, double T1,
                                  double T2) {
  CertificateSubject subject;
  subject.plant = linear_plant(A);
  ModeMatrices& mode = subject.plant.modes.front();
  mode.A_d = A_d;
  mode.C_d = Eigen::MatrixXd::Identity(1, A.rows());
  subject.T1 = T1;
  subject.T2 = T2;
  return subject;
}

inline CertificateSubject impulsive() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = 1.0;
  Eigen::MatrixXd A_d(3, 3);
  A_d << 1, 0, 0, 0, 1, 0, 1, 0, 0;
  return jumping(A, A_d, 2.0, 5.0);
}

inline CertificateSubject bouncing_ball(double T2 = 5.0) {
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, 0, -0.1;
  Eigen::MatrixXd A_d(2, 2);
  A_d << -1, 0, 0, -0.8;
  return jumping(A, A_d, 0.0, T2);
}

inline CertificateSubject neuron() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = -1.0;
  A(1, 1) = -0.02;
  Eigen::MatrixXd A_d(3, 3);
  A_d << 0, 0, 0, 0, 1, 1, 0, 0, 1;
  return jumping(A, A_d, 30.0, 50.0);
}

/// Mode 1 turns about the third axis, mode 2 about the first.
inline CertificateSubject switched() {
  Eigen::MatrixXd A1 = Eigen::MatrixXd::Zero(3, 3);
  A1(0, 1) = 1.0;
  A1(1, 0) = -1.0;
  CertificateSubject subject;
  subject.plant = linear_plant(A1);
  subject.plant.modes.push_back(subject.plant.mode());
  ModeMatrices& second = subject.plant.modes.back();
  second.A = Eigen::MatrixXd::Zero(3, 3);
  second.A(1, 2) = 1.0;
  second.A(2, 1) = -1.0;
  for (std::size_t i = 0; i < 2; ++i) {
    subject.plant.modes[i].label = static_cast<int>(i) + 1;
    subject.plant.modes[i].C_d = Eigen::MatrixXd::Identity(1, 3);
  }
  subject.T1 = 0.6;
  subject.T2 = 1.4;
  return subject;
}

inline Design designed(const char* method, const CertificateSubject& subject,
                       Objective objective = Objective::kFeasible, Parameters given = {}) {
  DesignProblem problem;
  problem.subject = subject;
  problem.objective = objective;
  problem.given = std::move(given);
  SynthesisOptions options;
  options.jobs = 2;
  Design design = synthesize(*find_design_method(method), problem, options);
  EXPECT_TRUE(all_hold(check(design.certificate)))
      << describe_violations(check(design.certificate));
  return design;
}

inline double spectral_radius(const Eigen::MatrixXd& a) {
  return eigenvalues_of(a).cwiseAbs().maxCoeff();
}

}  // namespace sampled_data_observers
