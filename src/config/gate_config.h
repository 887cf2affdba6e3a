#pragma once

#include <optional>
#include <vector>

#include "observer/gated_measurements.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Reads the section `gate` of each sensor, below `sensors`: one per sensor, nothing for a sensor
/// without.
/// @throws ConfigError for the first fault found.
std::vector<std::optional<Gate>> read_gates(ConfigSection& root, const Plant& plant,
                                            const ObserverLaw& law);

}  // namespace sampled_data_observers
