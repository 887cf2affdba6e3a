#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// The maps of a plant written in C++.
struct CompiledPlant {
  std::vector<std::string> state_names;   ///< n
  std::vector<std::string> input_names;   ///< p
  std::shared_ptr<const VectorMap> flow;  ///< f: n
  std::shared_ptr<const VectorMap> jump;  ///< g: n; null where the plant does not jump
  /// Output maps by the names by which configurations choose them.
  std::map<std::string, std::shared_ptr<const VectorMap>> outputs;
};

/// Base class of plants in plug-ins (pluginlib), for models that formulas can't express or that
/// must be fast. A configuration names the class in plant/plugin.
class PlantPlugin {
 public:
  virtual ~PlantPlugin() = default;

  /// Makes the plant with the values that plant/parameters gives.
  /// @throws std::invalid_argument, with a message for the user, for a parameter that is missing,
  /// unknown or of no use.
  virtual CompiledPlant build(const std::map<std::string, double>& parameters) const = 0;
};

}  // namespace sampled_data_observers
