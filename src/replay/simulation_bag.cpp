#include "replay/simulation_bag.h"

#include <ros/names.h>

#include <vector>

#include "console/progress_bar.h"
#include "messages/simulated_messages.h"
#include "replay/bag_writer.h"

namespace sampled_data_observers {

SimulationSummary record_simulation(const Scenario& scenario, const std::string& path) {
  Simulator simulator(scenario);
  SimulationSummary summary;
  std::vector<std::string> topics;
  for (const SimulatedChannel& channel : simulator.channels()) {
    topics.push_back(ros::names::resolve(channel.topic));
    summary.messages[topics.back()] = 0;
  }
  const SimulatedMessages messages(simulator.channels(), scenario.navsat);
  BagWriter bag(path);
  ProgressBar progress("simulate", static_cast<std::size_t>(scenario.duration));
  while (const std::optional<SimulatedMessage> simulated = simulator.next()) {
    const std::string& topic = topics[simulated->channel];
    messages.visit(*simulated, [&](const auto& message) {
      bag.write(topic, to_ros_time(simulated->arrival), message);
    });
    ++summary.messages[topic];
    progress.advance_to(static_cast<std::size_t>(simulator.time()));
  }
  bag.finish();
  summary.jumps = simulator.describe_jumps();
  summary.end = simulator.describe_end();
  return summary;
}

}  // namespace sampled_data_observers
