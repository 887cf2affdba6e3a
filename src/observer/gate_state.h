#pragma once

#include <cstdint>

#include "sampled_data_observers/hybrid/state_layout.h"

namespace sampled_data_observers {

/// What the state of a law holds of one gate: whether it is open, and for how long it has rejected
/// all that came. A gate is open, and lets everything pass, from the start until something lies
/// inside it: an initial estimate is no measure of outliers. When all that came for a while,
/// counted from the first one rejected, was rejected, it recovers: what follows passes until
/// something lies inside.
class GateState {
 public:
  enum class Verdict : std::uint8_t {
    kPass,    ///< inside, or the gate is open
    kReject,  ///< outside
    kRecover  ///< outside, as all others for too long: it passes
  };

  /// @param layout         hands out what the gate keeps
  /// @param recover_after  time of rejections only after which it recovers [ns], > 0
  GateState(StateLayout& layout, Duration recover_after)
      : standing_(layout.choice<Standing>()),
        since_rejected_(layout.timer(static_cast<double>(recover_after))) {}

  /// Opens it.
  void initialize(double* state) const {
    standing_.set(Standing::kOpen, state);
    since_rejected_.restart(state);
  }

  /// Lets time pass.
  void advance(Duration duration, double* state) const { since_rejected_.advance(duration, state); }

  /// Takes in that something came, inside the gate or outside.
  Verdict judge(bool is_outside, double* state) const {
    if (!is_outside) {
      standing_.set(Standing::kClosed, state);
      return Verdict::kPass;
    }
    if (standing_.of(state) == Standing::kOpen) return Verdict::kPass;
    if (standing_.of(state) == Standing::kClosed) {
      standing_.set(Standing::kRejecting, state);
      since_rejected_.restart(state);
    }
    return since_rejected_.is_over(state) ? Verdict::kRecover : Verdict::kReject;
  }

 private:
  enum class Standing : std::uint8_t {
    kOpen,      ///< nothing was inside since the start
    kClosed,    ///< the last one was inside
    kRejecting  ///< it was not, and was rejected
  };

  ChoiceSlot<Standing> standing_;
  TimerSlot since_rejected_;  ///< the first of those rejected one after another
};

}  // namespace sampled_data_observers
