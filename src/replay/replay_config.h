#pragma once

#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

/// The configuration of files for bags: places of frames in it (FramePlace) are those of the bags'
/// /tf_static.
/// @throws ConfigError, ReplayError
ObserverConfig read_replay_config(const std::vector<std::string>& files,
                                  const std::vector<std::string>& bags);

}  // namespace sampled_data_observers
