#pragma once

#include <memory>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Reads the section `gate` of each sensor, below `sensors`. Returns `law` with these gates, or
/// itself where there are none.
/// @throws ConfigError for the first fault found.
std::shared_ptr<const ObserverLaw> read_gates(ConfigSection& root, const Plant& plant,
                                              std::shared_ptr<const ObserverLaw> law);

}  // namespace sampled_data_observers
