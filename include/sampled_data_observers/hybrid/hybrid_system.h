#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "sampled_data_observers/hybrid/event.h"
#include "sampled_data_observers/hybrid/state_layout.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// What an event did to the state.
enum class Effect : std::uint8_t {
  kApplied,
  kRefused,         ///< nothing: a jump that comes too soon after others
  kNotPossible,     ///< nothing: a jump where the estimate lies outside the jump set
  kRepeated,        ///< nothing: a jump with the number of the one before
  kGated,           ///< nothing: a measurement whose innovation lies outside its gate
  kPastGate,        ///< applied although it lies outside its gate: so did all others for too long
  kRestarted,       ///< the same, to an estimate that began anew
  kWithoutOutputs,  ///< a jump, applied without what was measured at it: no finite correction
  kOutputsGated,    ///< a jump, applied without those of its outputs that lie outside their gates
  kWithdrawn,       ///< nothing: a jump that was withdrawn
  kWithdrawal,      ///< of a withdrawal: it takes a jump out
  kNoSuchJump,      ///< of a withdrawal: nothing, there is no such jump
  kNotFinite        ///< nothing: the result would not have been finite
};

/// Whether the event reset the state.
constexpr bool took_effect(Effect effect) {
  return effect == Effect::kApplied || effect == Effect::kPastGate ||
         effect == Effect::kRestarted || effect == Effect::kWithoutOutputs ||
         effect == Effect::kOutputsGated;
}

/// A hybrid system whose jumps are driven by events: it flows between them and is reset at them.
///
/// Immutable once built; the state is the caller's: state_size() numbers at `state`. The maps
/// allocate nothing and throw nothing: what they need beside the state they find at `workspace`,
/// workspace_size() numbers that mean nothing between calls. A map may leave non-finite numbers in
/// the state; the Timeline handles that.
class HybridSystem {
 public:
  virtual ~HybridSystem() = default;
  HybridSystem& operator=(const HybridSystem&) = delete;

  /// Number of entries of the state.
  Eigen::Index state_size() const { return state_layout_.size(); }

  /// Number of entries that the maps need in `workspace`.
  Eigen::Index workspace_size() const { return workspace_layout_.size(); }

  /// Largest number of values of an event.
  Eigen::Index max_event_size() const { return facts_.max_event_size; }

  /// Number of sensors.
  std::size_t sensors() const { return facts_.sensors; }

  /// Where not 0: a flow may be split at whole multiples of this without changing a bit of its
  /// result [ns]. It lets a query go on from where an earlier one came to.
  Duration flow_step() const { return facts_.flow_step; }

  /// The longest flow from an event that can be computed in bearable time [ns]; longer ones count
  /// as not finite.
  Duration flow_horizon() const { return facts_.flow_horizon; }

  /// Whether the system has such events: of that kind and sensor, with so many values, and with a
  /// mode or without. Which mode it is does not matter.
  virtual bool accepts(const Event& event) const = 0;

  /// The state before the first event.
  virtual void initialize(double* state) const = 0;

  /// Flow map: carries the state over `duration` >= 0.
  virtual void flow(Duration duration, double* state, double* workspace) const = 0;

  /// In place of a flow over `duration` >= 0 that is not finite: all timers in the state move, and
  /// nothing else; nobody vouches for it any more.
  void hold(Duration duration, double* state) const {
    advance_timers(duration, state);
    distrust(state);
  }

  /// Told where nobody vouches for the state any more, since it was held, or since a jump of the
  /// plant had no effect because its result is not finite: for systems that keep what must not
  /// outlive that.
  virtual void distrust(double* state) const { static_cast<void>(state); }

  /// Reset map of an event that it accepts; of no jump that was withdrawn. Where the event must not
  /// take effect, nothing changes but what the system remembers of such events. Never returns
  /// kNotFinite.
  virtual Effect reset(const Event& event, double* state, double* workspace) const = 0;

 protected:
  /// What holds of a system for ever.
  struct Facts {
    Eigen::Index max_event_size = 0;                               ///< max_event_size()
    std::size_t sensors = 0;                                       ///< sensors()
    Duration flow_step = 0;                                        ///< flow_step()
    Duration flow_horizon = std::numeric_limits<Duration>::max();  ///< flow_horizon()
  };

  HybridSystem() = default;

  /// For a system around another one: it begins with the facts of that one, its state with that
  /// one's state and its workspace with that one's workspace.
  HybridSystem(const HybridSystem&) = default;

  /// What a system keeps in its state is handed out here while it is built.
  StateLayout& state_layout() { return state_layout_; }
  /// Lets time pass for all timers that it handed out, those of the system within among them.
  void advance_timers(Duration duration, double* state) const {
    state_layout_.advance_timers(duration, state);
  }
  /// What its maps need beside the state, likewise: a part of the workspace that no other one
  /// shares.
  VectorSlot scratch(Eigen::Index entries) { return workspace_layout_.vector(entries); }

  /// To be set while the system is built.
  Facts& facts() { return facts_; }

 private:
  StateLayout state_layout_;
  StateLayout workspace_layout_;
  Facts facts_;
};

}  // namespace sampled_data_observers
