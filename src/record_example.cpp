// rosrun sampled_data_observers record_example CONFIG... -o OUT.bag
#include <ros/init.h>

#include <CLI/CLI.hpp>

#include "sampled_data_observers/replay/example_recording.h"
#include "sampled_data_observers/replay/tool_main.h"

namespace sdo = sampled_data_observers;

namespace {

int run(int argc, char** argv) {
  ros::init(argc, argv, "record_example",
            ros::init_options::AnonymousName | ros::init_options::NoRosout);
  CLI::App app{
      "Simulates the plant of a configuration and records a bag of what its sensors send: samples "
      "at "
      "random times in [T1, T2], late and some of them twice; the input sin t; the "
      "true state."};
  std::vector<std::string> config_files;
  std::string output;
  sdo::RecordingOptions options;
  app.add_option("config", config_files, "Configuration files")->required()->type_name("CONFIG");
  app.add_option("-o,--output", output, "Bag to write")->required();
  app.add_option("--duration", options.duration, "Length [s] (default 40)")
      ->check(CLI::Range(0.1, 1e6));
  app.add_option("--seed", options.seed, "Seed of the random numbers (default 1)");
  app.add_option("--latency", options.latency, "Longest latency of a sample [s] (default 0.05)")
      ->check(CLI::Range(0.0, 1e3));
  app.add_option("--noise", options.noise, "Half width of the noise on each output (default 0)")
      ->check(CLI::Range(0.0, 1e9));
  CLI11_PARSE(app, argc, argv);
  sdo::record_example(sdo::read_observer_config(config_files), options, output);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("record_example", run, argc, argv);
}
