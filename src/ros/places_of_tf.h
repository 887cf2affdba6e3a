#pragma once

#include "sampled_data_observers/config/config_node.h"
#include "sampled_data_observers/ros/node_log.h"

namespace sampled_data_observers {

/// A configuration with numbers for the places of frames in it (FramePlace), as /tf_static has
/// them. Waits for them as long as the configuration says.
/// @throws ConfigError for one that is not known then.
ConfigNode with_places_of_tf(ConfigNode tree, const NodeLog& log);

}  // namespace sampled_data_observers
