#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers::test {

/// A law with a state, driven by hand.
class LawRunner {
 public:
  explicit LawRunner(std::shared_ptr<const ObserverLaw> law)
      : law_(std::move(law)), state_(law_->state_size()), workspace_(law_->workspace_size()) {
    law_->initialize(state_.data());
  }

  void start_from(const Eigen::VectorXd& estimate) {
    law_->observer().start_from(estimate.data(), state_.data());
  }
  void flow(Duration duration) { law_->flow(duration, state_.data(), workspace_.data()); }
  bool sample(int sensor, std::vector<double> y) { return reset(EventKind::kSample, sensor, y); }
  bool output(int sensor, std::vector<double> y) { return reset(EventKind::kOutput, sensor, y); }
  bool jump_output(int sensor, std::vector<double> y) {
    return reset(EventKind::kJumpOutput, sensor, y);
  }
  bool input(std::vector<double> u) { return reset(EventKind::kInput, 0, u); }
  bool jump(const std::vector<double>& y_d = {}, std::optional<double> mode = std::nullopt) {
    return reset(
        {1, EventKind::kJump, 0, y_d.data(), static_cast<Eigen::Index>(y_d.size()), 0, mode});
  }
  bool release(Duration delay) {
    Event event;
    event.kind = EventKind::kRelease;
    event.delay = delay;
    return reset(event);
  }

  Eigen::VectorXd estimate() const { return state_.head(law_->estimate_size()); }
  const Eigen::VectorXd& state() const { return state_; }

 private:
  bool reset(EventKind kind, int sensor, const std::vector<double>& values) {
    return reset({1, kind, sensor, values.data(), static_cast<Eigen::Index>(values.size())});
  }
  bool reset(const Event& event) {
    EXPECT_TRUE(law_->accepts(event));
    return took_effect(law_->reset(event, state_.data(), workspace_.data()));
  }

  std::shared_ptr<const ObserverLaw> law_;
  Eigen::VectorXd state_;
  Eigen::VectorXd workspace_;
};

}  // namespace sampled_data_observers::test
