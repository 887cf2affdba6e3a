#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_node.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// A parameter of formulas that is a place: where the origin of a frame is in another, both rigidly
/// attached to each other. `NAME: {frame: base_link, child_frame: gps}` below plant/parameters
/// stands for the numbers NAME_x, NAME_y and NAME_z [m].
struct FramePlace {
  std::string name;         ///< that the names of the numbers begin with
  std::string frame;        ///< whose axes they are along
  std::string child_frame;  ///< whose origin it is
  Duration timeout = 0;     ///< how long a start waits for it [ns]
};

/// All of a configuration. @throws ConfigError for one that is none.
std::vector<FramePlace> frame_places(const ConfigNode& tree);

/// Where it is; nothing: that is not known.
using PlaceFinder = std::function<std::optional<Eigen::Vector3d>(const FramePlace&)>;

/// The configuration with numbers for all of them.
/// @throws ConfigError for one that is none, or not known.
ConfigNode with_places(ConfigNode tree, const PlaceFinder& find);

}  // namespace sampled_data_observers
