#pragma once

#include "sampled_data_observers/design/certify.h"
#include "sampled_data_observers/design/packing.h"
#include "sampled_data_observers/design/workers.h"

namespace sampled_data_observers {

/// certify_here() in a worker process, as the solver needs it. Of the candidate only values, margin
/// and message come back.
inline DesignCandidate certified(const char* theorem, const CertificateSubject& subject,
                                 const NamedMatrices& fixed,
                                 Objective objective = Objective::kFeasible) {
  const auto task = [&](std::size_t) {
    const DesignCandidate candidate =
        certify_here(*find_theorem(theorem), subject, fixed, objective);
    Packer packer;
    packer.add(candidate.values);
    packer.add(candidate.margin);
    packer.add(candidate.message);
    return packer.bytes();
  };
  const WorkerOutcome outcome = run_in_workers(1, task, WorkerOptions()).front();
  DesignCandidate candidate;
  if (outcome.status != WorkerOutcome::Status::kDone) {
    candidate.message = outcome.result;
    return candidate;
  }
  Unpacker unpacker(outcome.result);
  candidate.values = unpacker.matrices();
  candidate.margin = unpacker.number();
  candidate.message = unpacker.text();
  return candidate;
}

/// The first mode of a plant without outputs, disturbance or performance output.
inline PlantMatrices linear_plant(const Eigen::MatrixXd& A) {
  const Eigen::Index n = A.rows();
  PlantMatrices plant;
  ModeMatrices mode;
  mode.A = A;
  mode.C.resize(0, n);
  mode.C_c.resize(0, n);
  mode.C_d.resize(0, n);
  plant.modes = {mode};
  for (Eigen::Index i = 1; i <= n; ++i) plant.state_names.push_back("x" + std::to_string(i));
  plant.G.resize(n, 0);
  plant.S.resize(0, n);
  plant.N.resize(n, 0);
  plant.C_p.resize(0, n);
  return plant;
}

}  // namespace sampled_data_observers
