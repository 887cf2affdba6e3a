#pragma once

#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "simulation/schedule.h"

namespace sampled_data_observers {

// The durations that schedules and scenarios take [s]: one tick of the clock is the least.
constexpr double kShortest = 1e-9;
constexpr double kLongest = 1e6;

/// Where a schedule of a fixed period begins.
enum class FirstOfPeriod { kAtStart, kAfterPeriod };

/// Reads the key `schedule` of `owner`: uniform, sine, period or file. A relative file is looked
/// for beside the configuration file.
Schedule read_schedule(ConfigSection& owner, FirstOfPeriod first);

/// The one key of a section that is there to choose among several.
/// @throws ConfigError where it has none, another, or several.
std::string only_key(ConfigSection& section, const std::vector<std::string>& known);

}  // namespace sampled_data_observers
