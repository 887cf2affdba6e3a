#pragma once

#include <string>
#include <vector>

#include "config/sampling_config.h"
#include "simulation/scenario.h"

namespace sampled_data_observers {

/// What a person should know of schedules whose times between samples, or between jumps of a plant
/// without, are not all inside those of `sampling`: one text each. Losses on the way are not looked
/// at.
std::vector<std::string> schedules_outside(const Scenario& scenario,
                                           const SamplingConfig& sampling);

}  // namespace sampled_data_observers
