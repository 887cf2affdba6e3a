#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "design/certify.h"
#include "design/packing.h"
#include "design/workers.h"

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

/// An ErrorBound driven by flow and events, as GuaranteedBound does.
class DrivenBound {
 public:
  explicit DrivenBound(std::unique_ptr<const ErrorBound> bound)
      : bound_(std::move(bound)),
        then_(static_cast<std::size_t>(bound_->state_size())),
        workspace_(static_cast<std::size_t>(bound_->workspace_size())) {
    bound_->initialize(then_.data());
    now_ = then_;
  }

  /// @param since  time since the last event [s]
  void flow_to(double since) {
    now_ = then_;
    bound_->flow(since, now_.data());
  }
  void sample() {
    bound_->sample(0, now_.data(), workspace_.data());
    then_ = now_;
  }
  /// @param moved  as ErrorBound takes it
  void jump(double moved = 0.0) {
    bound_->jump({moved}, now_.data());
    then_ = now_;
  }
  void uncorrected_jump(double moved = 0.0) {
    bound_->uncorrected_jump({moved}, now_.data());
    then_ = now_;
  }
  double value() const { return bound_->bound(now_.data()); }

 private:
  std::unique_ptr<const ErrorBound> bound_;
  std::vector<double> then_;
  std::vector<double> now_;
  std::vector<double> workspace_;
};

inline ErrorAssumptions assumptions(double initial_error, double noise, double disturbance) {
  ErrorAssumptions all;
  all.initial_error = initial_error;
  all.noise = noise;
  all.disturbance = disturbance;
  return all;
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
