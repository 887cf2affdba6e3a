// rosrun sampled_data_observers simulate SCENARIO... -o OUT.bag
#include <ros/init.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "console/option_checks.h"
#include "console/tool_main.h"
#include "messages/plant_plugins.h"
#include "replay/simulation_bag.h"
#include "simulation/scenario_config.h"

namespace sdo = sampled_data_observers;

namespace {

int run(int argc, char** argv) {
  // Takes topic remappings (from:=to, __ns:=...) off the command line, as for every ROS node.
  ros::init(argc, argv, "simulate", ros::init_options::AnonymousName | ros::init_options::NoRosout);

  CLI::App app{
      "Simulates the plant of a scenario and writes a bag with what a robot's sensors would send, "
      "at "
      "the times of arrival, and the truth; without roscore. Remappings (from:=to) hold as for a "
      "node."};
  std::vector<std::string> files;
  std::string output;
  double duration = 0.0;
  std::uint64_t seed = 0;
  app.add_option("scenario", files, "Scenario files; a key may stand in one of them only")
      ->required()
      ->type_name("SCENARIO");
  app.add_option("-o,--output", output, "Bag to write")->required();
  CLI::Option* seed_option = app.add_option("--seed", seed, "Instead of scenario/seed")
                                 ->check(sdo::whole_number_at_least(0));
  CLI::Option* duration_option =
      app.add_option("--duration", duration, "Instead of scenario/duration [s]")
          ->check(sdo::number_between(1e-9, 1e6));
  app.footer("Exit status: 0 done, 1 a fault in scenario or files, else wrong usage.");
  CLI11_PARSE(app, argc, argv);

  sdo::Scenario scenario = sdo::read_scenario(files, sdo::load_plant_plugin);
  if (*seed_option) scenario.seed = seed;
  if (*duration_option) scenario.duration = sdo::from_seconds(duration);
  const sdo::SimulationSummary summary = sdo::record_simulation(scenario, output);
  for (const auto& [topic, count] : summary.messages) {
    std::printf("%8zu messages on %s\n", count, topic.c_str());
  }
  std::printf("%8zu jumps\n%s\nwritten to %s\n", static_cast<std::size_t>(summary.jumps),
              summary.end.c_str(), output.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("simulate", run, argc, argv);
}
