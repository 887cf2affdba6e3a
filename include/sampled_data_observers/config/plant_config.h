#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/plant/expression_map.h"
#include "sampled_data_observers/plant/plant.h"
#include "sampled_data_observers/plant/plant_plugin.h"

namespace sampled_data_observers {

/// Finds the plug-in of a plant by the name of its class, "package/Class".
/// Throws std::runtime_error with a message for the user where there is none.
using PlantPluginLoader = std::function<std::shared_ptr<const PlantPlugin>(const std::string&)>;

/// Units, as people read them ("m/s"), of states, inputs and the outputs of sensors, by name. A
/// state and a sensor that share a name share the unit. Nothing is computed from them.
using Units = std::map<std::string, std::string>;

/// A plant and the names that formulas of the same configuration may use.
struct PlantConfig {
  /// Never null.
  std::shared_ptr<const Plant> plant;
  /// Of the states, the inputs and the parameters with their values.
  ExpressionNames names;
  /// As `plant/units` has them.
  Units units = {};
};

/// Reads the sections `plant` and `sensors` of `root` (the latter but for each sensor's source).
/// Sensors are in the order of their names.
/// @throws ConfigError for the first fault found.
PlantConfig read_plant(ConfigSection& root, const PlantPluginLoader& load_plugin);

}  // namespace sampled_data_observers
