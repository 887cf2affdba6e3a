#pragma once

#include <string>

namespace sampled_data_observers {

/// Reads a whole bag, and compares what its index promises with what is there: rosbag itself goes
/// by the index, and where a count in it is off it passes over messages in silence. Values of
/// messages are not looked at. Bags of version 1.2, which have no index, and encrypted ones are
/// left to rosbag.
/// @throws ReplayError that names the file and what is wrong.
void require_whole_bag(const std::string& path);

}  // namespace sampled_data_observers
