#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sampled_data_observers/config/yaml_file.h"
#include "simulation/scenario_config.h"
#include "simulation/simulator.h"

namespace sampled_data_observers::test {

/// Where a scenario begins.
inline constexpr Stamp kFirst = 1000 * kNanosecondsPerSecond;

inline Scenario parse_scenario(const std::string& text) {
  const auto no_plugins = [](const std::string&) -> std::shared_ptr<const PlantPlugin> {
    throw std::runtime_error("no plug-ins here");
  };
  return read_scenario(read_yaml_text(text, "test.yaml"), no_plugins);
}

/// All messages of a simulation, in the order of their arrival.
inline std::vector<SimulatedMessage> run(Simulator& simulator) {
  std::vector<SimulatedMessage> messages;
  while (const auto message = simulator.next()) messages.push_back(*message);
  return messages;
}

inline std::vector<SimulatedMessage> run(const std::string& text) {
  Simulator simulator(parse_scenario(text));
  return run(simulator);
}

/// Those of the channel with this topic.
inline std::vector<SimulatedMessage> on_topic(const Simulator& simulator,
                                              const std::vector<SimulatedMessage>& messages,
                                              const std::string& topic) {
  std::vector<SimulatedMessage> found;
  for (const SimulatedMessage& message : messages) {
    if (simulator.channels()[message.channel].topic == topic) found.push_back(message);
  }
  return found;
}

/// Whether two simulations sent the same.
inline bool same(const std::vector<SimulatedMessage>& a, const std::vector<SimulatedMessage>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& m, const auto& n) {
    return m.channel == n.channel && m.stamp == n.stamp && m.arrival == n.arrival &&
           m.values == n.values && m.mode == n.mode && m.jumps == n.jumps;
  });
}

}  // namespace sampled_data_observers::test
