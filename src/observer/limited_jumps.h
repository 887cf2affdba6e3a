#pragma once

#include <memory>

#include "observer/law_decorator.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Bounds on how fast jumps may follow each other: Zeno plants, bouncing contacts and mad detectors
/// must not take the observer along.
struct JumpLimits {
  /// Shortest time between two jumps that take effect [ns], >= 0.
  Duration min_separation = 0;
  /// Largest number of jumps in a second, in the long run; as many may come at once.
  double max_per_second = 0.0;
};

/// A law whose jumps take effect only within limits; the others leave the state alone. Which ones
/// do is a function of the jumps' stamps, not of their arrival.
class LimitedJumps : public LawDecorator {
 public:
  /// @throws std::invalid_argument for a negative separation or a rate below 1.
  LimitedJumps(std::shared_ptr<const ObserverLaw> law, const JumpLimits& limits);

  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  VectorSlot records_of_jumps() const override { return own_records(); }

 private:
  JumpLimits limits_;
  /// Since the last jump that took effect: for ever where there was none.
  TimerSlot since_ = state_layout().timer(1e18);
  /// How many may come at once now (a token bucket).
  NumberSlot tokens_ = state_layout().number();
};

}  // namespace sampled_data_observers
