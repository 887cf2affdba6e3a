#pragma once

#include <memory>

#include "observer/law_decorator.h"
#include "observer/state_set.h"
#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// Where a plant that jumps faster and faster comes to rest (Zeno).
struct RestState {
  /// What an estimate is taken to be at rest in, just after a jump.
  StateSet set;
  /// From x to the state at rest, n entries.
  std::shared_ptr<const VectorMap> state;
};

/// A law whose estimate rests from a jump on after which it lies in a set: it is put to its state
/// at rest, and does not flow. Nor does the rest of the law's state, but for its timers. Events
/// that leave the estimate in the set have no part in it; the first that takes it out moves it, and
/// it flows again.
///
/// That is no solution of the plant's model, so no bound on the error holds there. The law begins
/// each rest as it begins an estimate (PlantObserver::start_from()), a covariance with P0.
class RestingEstimate : public LawDecorator {
 public:
  /// @throws std::invalid_argument for maps and margins that do not fit the plant, and where
  /// outputs are continuous: they move the estimate all the time.
  RestingEstimate(const std::shared_ptr<const ObserverLaw>& law, RestState rest);

  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  VectorSlot records_of_estimate() const override { return own_records(); }

 private:
  bool is_in_set(const double* state, double* workspace) const;
  void lie_down(double* state, double* workspace) const;

  RestState rest_;
  FlagSlot is_at_rest_ = state_layout().flag();
  VectorSlot before_ = scratch(law().state_size());
  VectorSlot values_ = scratch(rest_.set.margins.size());
  VectorSlot x_ = scratch(estimate_size());
};

}  // namespace sampled_data_observers
