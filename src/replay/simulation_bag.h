#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "simulation/scenario.h"

namespace sampled_data_observers {

/// What was written into a bag.
struct SimulationSummary {
  /// Number of messages by topic.
  std::map<std::string, std::size_t> messages;
  /// How many jumps there were, and what was told of them wrongly, in words.
  std::string jumps;
  /// Why the simulation ended, in words.
  std::string end;
};

/// Runs a scenario and writes its messages into a bag, at the times of their arrival. Relative
/// topic names are resolved, and remapped, as ROS does it.
/// @throws ReplayError when the bag can't be written.
SimulationSummary record_simulation(const Scenario& scenario, const std::string& path);

}  // namespace sampled_data_observers
