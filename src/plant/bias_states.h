#pragma once

#include <string>
#include <vector>

#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// A constant state (ḃ = 0, unchanged by jumps) that is added to one output of a sensor: an unknown
/// bias as an exosystem (ferrante2016, example 2).
struct BiasState {
  std::string name;
  std::size_t sensor = 0;
  Eigen::Index output = 0;
};

/// Adds the bias states, in their order, behind the plant's states.
PlantDescription with_bias_states(PlantDescription plant, const std::vector<BiasState>& biases);

}  // namespace sampled_data_observers
