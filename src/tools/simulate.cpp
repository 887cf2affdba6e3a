// rosrun sampled_data_observers simulate SCENARIO... -o OUT.bag
#include <ros/init.h>

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "console/command_line.h"
#include "console/option_checks.h"
#include "console/output_checks.h"
#include "console/tool_main.h"
#include "messages/plant_plugins.h"
#include "replay/simulation_bag.h"
#include "simulation/scenario_config.h"

namespace sdo = sampled_data_observers;

namespace {

struct Arguments {
  std::vector<std::string> scenario;
  std::string output;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration;  // [s]
};

int simulate(const Arguments& arguments) {
  sdo::refuse_overwriting(sdo::given_files("SCENARIO", arguments.scenario),
                          {{"--output", arguments.output}});
  sdo::Scenario scenario = sdo::read_scenario(arguments.scenario, sdo::load_plant_plugin);
  for (const std::string& warning : scenario.warnings) {
    std::fprintf(stderr, "simulate: %s\n", warning.c_str());
  }
  if (arguments.seed) scenario.seed = *arguments.seed;
  if (arguments.duration) scenario.duration = sdo::from_seconds(*arguments.duration);
  const sdo::SimulationSummary summary = sdo::record_simulation(scenario, arguments.output);
  for (const auto& [topic, count] : summary.messages) {
    std::printf("%8zu messages on %s\n", count, topic.c_str());
  }
  std::printf("%s\n%s\nwritten to %s\n", summary.jumps.c_str(), summary.end.c_str(),
              arguments.output.c_str());
  return 0;
}

int run(int argc, char** argv) {
  // Takes topic remappings (from:=to, __ns:=...) off the command line, as for every ROS node.
  ros::init(argc, argv, "simulate", ros::init_options::AnonymousName | ros::init_options::NoRosout);

  sdo::CommandLine tool(
      "simulate",
      "Simulates the plant of a scenario and writes a bag with what a robot's sensors would send, "
      "at the times of arrival, and the truth; without roscore. Remappings (from:=to) hold as for "
      "a node.",
      "Exit status: 0 done, 1 a fault in scenario or files, else wrong usage.");
  Arguments arguments;
  tool.argument("SCENARIO...", arguments.scenario,
                "Scenario files; a key may stand in one of them only");
  tool.option("-o, --output BAG", arguments.output, "Bag to write").required();
  tool.option("--seed NUMBER", arguments.seed, "Instead of scenario/seed")
      .check(sdo::whole_number_at_least(0));
  tool.option("--duration SECONDS", arguments.duration, "Instead of scenario/duration [s]")
      .check(sdo::number_between(1e-9, 1e6));
  tool.action([&arguments] { return simulate(arguments); });
  return tool.run(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("simulate", run, argc, argv);
}
