#pragma once

#include <string>
#include <vector>

#include "sampled_data_observers/config/config_node.h"
#include "sampled_data_observers/config/plant_config.h"
#include "simulation/scenario.h"

namespace sampled_data_observers {

/// Reads plant, sensors and topics of a configuration tree and its section `scenario`; what an
/// observer reads beside them is left alone. doc/simulation.md describes each key.
/// @throws ConfigError for the first fault found.
Scenario read_scenario(const ConfigNode& tree, const PlantPluginLoader& load_plugin);

/// The same from YAML files, which are merged; a key may stand in one of them only.
Scenario read_scenario(const std::vector<std::string>& files, const PlantPluginLoader& load_plugin);

}  // namespace sampled_data_observers
