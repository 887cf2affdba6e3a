#pragma once

#include <memory>
#include <utility>

#include "sampled_data_observers/observer/observer_law.h"

namespace sampled_data_observers {

/// A law that changes how another one takes its events. Its state is the other's, with some slots
/// of its own behind.
class LawDecorator : public ObserverLaw {
 public:
  bool accepts(const Event& event) const override { return law_->accepts(event); }
  const double* awaited(const double* state) const override { return law_->awaited(state); }

  double gate_share(const Event& measured, const double* state, double* workspace) const override {
    return law_->gate_share(measured, state, workspace);
  }

  /// The law within.
  const ObserverLaw& law() const { return *law_; }

  /// What it keeps of the jumps that were told, whatever the estimate is.
  virtual VectorSlot records_of_jumps() const { return {}; }
  /// What it keeps that is true as long as the estimate goes on.
  virtual VectorSlot records_of_estimate() const { return {}; }

 protected:
  explicit LawDecorator(std::shared_ptr<const ObserverLaw> law)
      : ObserverLaw(*law), law_(std::move(law)) {}

  /// All that it keeps itself.
  VectorSlot own_records() const { return {law_->state_size(), state_size() - law_->state_size()}; }

 private:
  std::shared_ptr<const ObserverLaw> law_;
};

// Into the state of a law that begins, from the state `before` of another one, or of the same: what
// all layers of either keep that are of the same type.

/// What is known of jumps: their numbers, and when they came.
void keep_records_of_jumps(const ObserverLaw& from, const double* before, const ObserverLaw& law,
                           double* state);
/// What goes on with the estimate: whether it is at rest, and how its gates stand.
void keep_records_of_estimate(const ObserverLaw& from, const double* before, const ObserverLaw& law,
                              double* state);

}  // namespace sampled_data_observers
