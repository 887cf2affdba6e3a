#pragma once

#include <optional>

#include "certificate/certificate.h"
#include "observer/dwell_times_watch.h"
#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {

/// Reads the keys `dwell_time`, `average_dwell_time` and `reverse_average_dwell_time` of the
/// section `jumps`; nothing where none of them is there.
/// @throws ConfigError for the first fault found.
std::optional<DwellTimes> read_dwell_times(ConfigSection& jumps);

/// A dwell time in whole nanoseconds, which allows no jumps that it does not: tau rounded up, or
/// down for a reverse one, but for the rounding of the double itself.
DwellTimes::Average average_of(const DwellTime& dwell_time);

/// Adds to what is watched, if anything, what a claim is about: both must hold then.
void watch(const DwellTime& claimed, std::optional<DwellTimes>& times);

}  // namespace sampled_data_observers
