#pragma once

#include <memory>
#include <string>

#include "sampled_data_observers/plant/plant_plugin.h"

namespace sampled_data_observers {

/// Loads the plug-in "package/Class", which some package exports for this one (doc/extending.md).
/// @throws std::runtime_error that lists the plug-ins there are.
std::shared_ptr<const PlantPlugin> load_plant_plugin(const std::string& type);

}  // namespace sampled_data_observers
