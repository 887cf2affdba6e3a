#pragma once

#include <string>

#include "sampled_data_observers/config/config_node.h"

namespace sampled_data_observers {

/// Reads one YAML document. Origins of the nodes are "path:line".
/// @throws ConfigError when the file can't be read, isn't YAML, holds no map at its top, or has a
/// key twice.
ConfigNode read_yaml_file(const std::string& path);

/// The same from a text; `name` stands for the file in messages.
ConfigNode read_yaml_text(const std::string& text, const std::string& name);

}  // namespace sampled_data_observers
