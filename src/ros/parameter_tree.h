#pragma once

#include <ros/node_handle.h>

#include <string>

#include "sampled_data_observers/config/config_node.h"

namespace XmlRpc {
class XmlRpcValue;
}

namespace sampled_data_observers {

/// The configuration tree of a value of the parameter server. `name` stands for it in messages.
/// @throws ConfigError for a value that no configuration holds (binary data, times), and for more
/// than a file may hold.
ConfigNode to_config_node(const XmlRpc::XmlRpcValue& value, const std::string& name);

/// The configuration in the private parameters of a node. Files are loaded below `~config`, each
/// under a name of its own: as `text` and `path`, which launch/observer.launch does and which is
/// read as replay reads the file, or as the tree that rosparam makes of it. They are merged, and a
/// key may stand in one of them only. Every other private parameter overrides what the files say.
/// @throws ConfigError when there is none, or when two files have one key.
ConfigNode read_parameter_tree(const ros::NodeHandle& private_handle);

}  // namespace sampled_data_observers
