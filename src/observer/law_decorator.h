#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sampled_data_observers/observer/observer_law.h"

namespace sampled_data_observers {

/// A law that changes how another one takes its events. Its state is the other's, with some numbers
/// of its own behind.
class LawDecorator : public ObserverLaw {
 public:
  const std::vector<std::string>& estimate_names() const override { return law_->estimate_names(); }
  LawGains gains() const override { return law_->gains(); }
  Eigen::Index state_size() const override { return inner_size() + own_size_; }
  Eigen::Index workspace_size() const override { return law_->workspace_size(); }
  Eigen::Index event_size(EventKind kind, int channel) const override {
    return law_->event_size(kind, channel);
  }
  Eigen::Index max_event_size() const override { return law_->max_event_size(); }
  std::size_t sensors() const override { return law_->sensors(); }
  Duration flow_step() const override { return law_->flow_step(); }
  Duration flow_horizon() const override { return law_->flow_horizon(); }
  bool knows_mode(const Event& event) const override { return law_->knows_mode(event); }
  const double* held_part(const double* state) const override { return law_->held_part(state); }
  void keep_held(const double* part, double* state) const override { law_->keep_held(part, state); }
  double mode_of(const double* state) const override { return law_->mode_of(state); }
  void keep_mode(double mode, double* state) const override { law_->keep_mode(mode, state); }
  void fit_to(const Event& sample, double* state, double* workspace) const override {
    law_->fit_to(sample, state, workspace);
  }
  void start_from(const double* estimate, double* state) const override {
    law_->start_from(estimate, state);
  }
  const double* covariance(const double* state) const override { return law_->covariance(state); }
  void innovation(const Event& sample, const double* state, double* innovation) const override {
    law_->innovation(sample, state, innovation);
  }
  double mahalanobis_distance(const Event& sample, const double* state,
                              double* workspace) const override {
    return law_->mahalanobis_distance(sample, state, workspace);
  }
  double error_bound(const double* state) const override { return law_->error_bound(state); }
  BoundLoss bound_loss(const double* state) const override { return law_->bound_loss(state); }
  void keep_bound(const PublishedBound& bound, double* state) const override {
    law_->keep_bound(bound, state);
  }
  bool is_saturated(const double* state) const override { return law_->is_saturated(state); }
  void hold(double* state) const override { law_->hold(state); }
  bool delays_jumps() const override { return law_->delays_jumps(); }

 protected:
  LawDecorator(std::shared_ptr<const ObserverLaw> law, Eigen::Index own_size)
      : law_(std::move(law)), own_size_(own_size) {}

  const ObserverLaw& law() const { return *law_; }
  Eigen::Index inner_size() const { return law_->state_size(); }
  double* own(double* state) const { return state + inner_size(); }
  const double* own(const double* state) const { return state + inner_size(); }

 private:
  std::shared_ptr<const ObserverLaw> law_;
  Eigen::Index own_size_;
};

}  // namespace sampled_data_observers
