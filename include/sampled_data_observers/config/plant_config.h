#pragma once

#include <memory>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/plant/linear_plant.h"

namespace sampled_data_observers {

/// Reads the sections `plant` and `sensors` of `root` (the latter but for each sensor's source).
/// Sensors are in the order of their names.
/// @throws ConfigError for the first fault found.
std::shared_ptr<const LinearPlant> read_linear_plant(ConfigSection& root);

}  // namespace sampled_data_observers
