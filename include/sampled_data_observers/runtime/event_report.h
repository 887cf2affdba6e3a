#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "sampled_data_observers/hybrid/hybrid_system.h"
#include "sampled_data_observers/observer/innovation_watch.h"
#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/runtime/event_outcome.h"

namespace sampled_data_observers {

/// How the time since the previous sample compares with the configured bounds.
enum class IntervalCheck : std::uint8_t {
  kNone = 0,    ///< not a sample or jump that was used, the first one, or a jump beside samples
  kWithin = 1,  ///< in [T1, T2]
  kShort = 2,   ///< below T1
  kLong = 3     ///< above T2
};

/// What an event did.
struct EventReport {
  /// What became of it.
  EventOutcome outcome = EventOutcome::kUsed;
  /// Number of later events that were applied again.
  std::size_t rewound = 0;
  /// What the event did, where it was taken in.
  Effect effect = Effect::kApplied;
  /// Time since the newest sample of the same sensor, or the newest jump, that was used and has an
  /// earlier stamp; used samples and jumps only.
  std::optional<Duration> interval;
  /// How `interval` compares with T1 and T2, those of the sensor.
  IntervalCheck interval_check = IntervalCheck::kNone;
  /// How the newest jump of its stamp compares with the times between jumps that are configured;
  /// used jumps only.
  DwellCheck dwell_check = DwellCheck::kNone;
  /// The norm of the innovation of a sample or a continuous output, before it took effect; NaN for
  /// other events, and where there was no estimate.
  double innovation = std::numeric_limits<double>::quiet_NaN();
  /// Its entries, as many as the event has values, angles wrapped; null where `innovation` is NaN.
  /// They live until the next event is taken in.
  const double* innovations = nullptr;
  /// Its size beside the sensor's gate (ObserverLaw::gate_share()); NaN as `innovation`, and where
  /// there is no gate.
  double gate_share = std::numeric_limits<double>::quiet_NaN();
  /// The normalized innovation squared, νᵀ S⁻¹ ν, whose mean is the number of outputs where the
  /// filter's model is right; NaN as `innovation`, and where the observer has no covariance.
  double nis = std::numeric_limits<double>::quiet_NaN();
  /// Whether an estimate of its stamp or a later one was published with a finite bound before this
  /// input or jump came: that bound was one of a run without it. Or whether its number tells of a
  /// jump that was lost, perhaps before an estimate that was published with a finite bound.
  bool came_after_bound = false;
  /// What the innovations of its sensor do.
  InnovationTrend trend = InnovationTrend::kSteady;

  /// Whether the estimate rests on it.
  bool used() const { return is_use(outcome); }
  /// Whether the measurement or jump was used since its gate had kept out all others for too long.
  bool recovers() const { return effect == Effect::kPastGate || effect == Effect::kRestarted; }
};

/// The outcome in a few words, whether a gate recovered, and why outputs were skipped.
const char* describe(const EventReport& report);

}  // namespace sampled_data_observers
