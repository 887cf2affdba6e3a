#include "sampled_data_observers/hybrid/split_flow.h"

#include <algorithm>
#include <utility>

#include "linear_algebra/kernels.h"

namespace sampled_data_observers {

Duration whole_steps(const HybridSystem& system, Duration duration) {
  const Duration step = system.flow_step();
  return step == 0 ? 0 : duration - duration % step;
}

bool is_usable(const Eigen::Ref<const Eigen::VectorXd>& state) {
  constexpr double kLargest = 1e150;
  return kernels().all_within(state.data(), state.size(), kLargest);
}

void SplitFlow::begin(std::shared_ptr<const HybridSystem> system, Duration duration, bool held) {
  system_ = std::move(system);
  duration_ = duration;
  whole_ = whole_steps(*system_, duration);
  reached_ = 0;
  is_held_ = duration == 0 && held;
  state_.resize(system_->state_size());
  origin_.resize(system_->state_size());
  workspace_.resize(system_->workspace_size());
}

bool SplitFlow::proceed(std::int64_t steps) {
  if (reached_ == 0) origin_ = state_;
  if (duration_ > system_->flow_horizon()) {
    hold();
    return true;
  }
  if (reached_ < whole_) {
    const Duration left = (whole_ - reached_) / system_->flow_step();
    const Duration part = std::min<Duration>(left, steps) * system_->flow_step();
    system_->flow(part, state_.data(), workspace_.data());
    reached_ += part;
    if (reached_ < whole_) return false;
  }
  system_->flow(duration_ - whole_, state_.data(), workspace_.data());
  if (!is_usable(state_)) hold();
  return true;
}

void SplitFlow::hold() {
  is_held_ = true;
  state_ = origin_;
  system_->hold(duration_, state_.data());
}

}  // namespace sampled_data_observers
