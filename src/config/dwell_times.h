#pragma once

#include <optional>

#include "observer/dwell_times_watch.h"
#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {

/// Reads the keys `dwell_time`, `average_dwell_time` and `reverse_average_dwell_time` of the
/// section `jumps`; nothing where none of them is there.
/// @throws ConfigError for the first fault found.
std::optional<DwellTimes> read_dwell_times(ConfigSection& jumps);

}  // namespace sampled_data_observers
