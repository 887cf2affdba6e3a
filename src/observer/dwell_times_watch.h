#pragma once

#include <memory>
#include <optional>

#include "observer/law_decorator.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// What is known of the times between jumps of a plant (bernard2022, Definition 2.1). N(t, s) is
/// the number of jumps between s and t.
struct DwellTimes {
  /// Jumps on average.
  struct Average {
    Duration tau = 0;  ///< τ* [ns], > 0
    double N0 = 1.0;   ///< a whole number, >= 1
  };

  /// The times between two jumps lie in [shortest, longest], and that before the first is not above
  /// the longest [ns].
  Duration shortest = 0;
  std::optional<Duration> longest;  ///< nothing: no bound
  /// N(t, s) <= (t − s) / τ* + N0 for all s <= t.
  std::optional<Average> average;
  /// N(t, s) >= (t − s) / τ* − N0 for all s <= t.
  std::optional<Average> reverse_average;
};

/// A law that watches whether the jumps that take effect come at times as they should
/// (DwellWatch). Which do is a function of the events, however flows are divided.
class DwellTimesWatch : public LawDecorator, private DwellWatch {
 public:
  /// @throws std::invalid_argument for times out of range.
  DwellTimesWatch(std::shared_ptr<const ObserverLaw> law, const DwellTimes& times);

  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  VectorSlot records_of_jumps() const override { return own_records(); }

 private:
  DwellCheck dwell_check(const double* state) const override { return check_.of(state); }
  double dwell_violations(const double* state) const override;

  void take_jump(double* state) const;
  bool is_overdue(const double* state) const;
  bool are_too_few(const double* state) const;

  DwellTimes times_;

  TimerSlot since_ = state_layout().timer();  ///< the last jump, or the start
  FlagSlot had_jump_ = state_layout().flag();
  /// After the last jump, over all times s before, whole nanoseconds: τ* times the most of
  /// N − (t − s) / τ*, and of (t − s) / τ* − N.
  NumberSlot most_ = state_layout().number();
  NumberSlot lack_ = state_layout().number();
  NumberSlot violations_ = state_layout().number();  ///< up to the last jump
  ChoiceSlot<DwellCheck> check_ = state_layout().choice<DwellCheck>();
};

}  // namespace sampled_data_observers
