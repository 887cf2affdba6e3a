#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "sampled_data_observers/observer/observer_law.h"

namespace sampled_data_observers::test {

/// A law with a state, driven by hand.
class LawRunner {
 public:
  explicit LawRunner(std::shared_ptr<const ObserverLaw> law)
      : law_(std::move(law)), state_(law_->state_size()), workspace_(law_->workspace_size()) {
    law_->initialize(state_.data());
  }

  void flow(Duration duration) { law_->flow(duration, state_.data(), workspace_.data()); }
  bool sample(int sensor, std::vector<double> y) { return reset(EventKind::kSample, sensor, y); }
  bool output(int sensor, std::vector<double> y) { return reset(EventKind::kOutput, sensor, y); }
  bool jump_output(int sensor, std::vector<double> y) {
    return reset(EventKind::kJumpOutput, sensor, y);
  }
  bool input(std::vector<double> u) { return reset(EventKind::kInput, 0, u); }
  bool jump() { return reset(EventKind::kJump, kPlainJump, {}); }
  bool jump(std::vector<double> values) { return reset(EventKind::kJump, kMeasuredJump, values); }
  bool release(Duration delay) {
    return reset(EventKind::kRelease, 0, {static_cast<double>(delay)});
  }

  Eigen::VectorXd estimate() const { return state_.head(law_->estimate_size()); }
  const Eigen::VectorXd& state() const { return state_; }

 private:
  bool reset(EventKind kind, int channel, const std::vector<double>& values) {
    EXPECT_EQ(static_cast<Eigen::Index>(values.size()), law_->event_size(kind, channel));
    const Event event{1, kind, channel, values.data(), static_cast<Eigen::Index>(values.size()), 0};
    return took_effect(law_->reset(event, state_.data(), workspace_.data()));
  }

  std::shared_ptr<const ObserverLaw> law_;
  Eigen::VectorXd state_;
  Eigen::VectorXd workspace_;
};

}  // namespace sampled_data_observers::test
