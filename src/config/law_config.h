#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "certificate/error_bound.h"
#include "observer/dwell_times_watch.h"
#include "observer/gated_measurements.h"
#include "observer/limited_jumps.h"
#include "observer/missing_jumps.h"
#include "observer/possible_jumps.h"
#include "observer/resting_estimate.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/plant_config.h"

namespace sampled_data_observers {

/// By how much the stamps of jumps may be off: `stamp_error` of the section `jumps` [s].
double read_stamp_error(ConfigSection& jumps);

/// Reads the keys `observer`, `initial_estimate` and `gains`, and `stamp_error` of `jumps`: the law
/// alone, with zero as its first input.
/// @throws ConfigError for the first fault found.
std::shared_ptr<const ObserverLaw> read_law(ConfigSection& root, const PlantConfig& plant);

/// What lies around a law.
struct LawLayers {
  bool delays_jumps = false;
  std::optional<JumpLimits> jump_limits;    ///< nothing where the plant does not jump
  std::optional<JumpGate> jump_gate;        ///< nothing where all jumps are believed
  std::optional<MissingJumps> missing;      ///< nothing where nobody looks for missing jumps
  std::optional<RestState> rest;            ///< nothing where the estimate never rests
  std::optional<DwellTimes> dwell_times;    ///< nothing where jumps may come at any times
  std::unique_ptr<const ErrorBound> bound;  ///< null where none is asked for
  double noise = 0.0;                       ///< that the bound rests on
  std::vector<std::optional<Gate>> gates;   ///< one per sensor
};

/// GatedMeasurements( GuaranteedBound( DwellTimesWatch( NumberedJumps( PossibleJumps( LimitedJumps(
/// MissingJumpsWatch( RestingEstimate( DelayedJumps( law ) ) ) ) ) ) ) ) ), each where it is asked
/// for, so that jumps that are made up lead to rest, too. Limits count jumps when they happen,
/// whether delayed or not, and those only that are told. Times between them are those between jumps
/// that take effect. The bound sees which of them were refused and which are missing, and must not
/// see the samples that a gate keeps out.
std::shared_ptr<const ObserverLaw> assemble(std::shared_ptr<const ObserverLaw> law,
                                            const std::shared_ptr<const Plant>& plant,
                                            LawLayers layers);

}  // namespace sampled_data_observers
