#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "sampled_data_observers/hybrid/event.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// What an event did to the state.
enum class Effect : std::uint8_t {
  kApplied,
  kRefused,    ///< nothing: a jump that comes too soon after others
  kGated,      ///< nothing: a sample whose innovation lies outside its gate
  kPastGate,   ///< applied although it lies outside its gate: so did all others for too long
  kRestarted,  ///< the same, to an estimate that began anew
  kNotFinite   ///< nothing: the result would not have been finite
};

/// Whether the event reset the state.
constexpr bool took_effect(Effect effect) {
  return effect == Effect::kApplied || effect == Effect::kPastGate || effect == Effect::kRestarted;
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

  /// Number of entries of the state.
  virtual Eigen::Index state_size() const = 0;

  /// Number of entries that the maps need in `workspace`.
  virtual Eigen::Index workspace_size() const = 0;

  /// Number of values that an event of this kind and channel carries; -1 where there is no such
  /// channel. Channels of samples are numbers of sensors; there are sensors().
  virtual Eigen::Index event_size(EventKind kind, int channel) const = 0;

  /// Largest event_size() of all channels.
  virtual Eigen::Index max_event_size() const = 0;

  /// Number of sensors.
  virtual std::size_t sensors() const = 0;

  /// The state before the first event.
  virtual void initialize(double* state) const = 0;

  /// Flow map: carries the state over `duration` >= 0.
  virtual void flow(Duration duration, double* state, double* workspace) const = 0;

  /// Where not 0: a flow may be split at whole multiples of this without changing a bit of its
  /// result [ns]. It lets a query go on from where an earlier one came to.
  virtual Duration flow_step() const { return 0; }

  /// The longest flow from an event that can be computed in bearable time [ns]; longer ones count
  /// as not finite.
  virtual Duration flow_horizon() const { return std::numeric_limits<Duration>::max(); }

  /// Told where the state is held instead of flowed, since the flow is not finite, and where a jump
  /// of the plant had no effect, since its result is not: for systems that keep what must not
  /// outlive that.
  virtual void hold(double* state) const { static_cast<void>(state); }

  /// Reset map of an event that event_size() accepts. Where the event must not take effect, nothing
  /// changes but what the system remembers of such events. Never returns kNotFinite.
  virtual Effect reset(const Event& event, double* state, double* workspace) const = 0;
};

}  // namespace sampled_data_observers
