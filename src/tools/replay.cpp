// rosrun sampled_data_observers replay BAG CONFIG... -o OUT.bag
#include "replay/replay.h"

#include <ros/init.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "console/option_checks.h"
#include "console/tool_main.h"
#include "messages/plant_plugins.h"
#include "replay/plot.h"

namespace sdo = sampled_data_observers;

namespace {

// Exit statuses, beside 1 for faults.
constexpr int kGuaranteeBroken = 2;
constexpr int kDiverged = 3;

std::map<std::string, std::string> parse_fields(const std::vector<std::string>& assignments) {
  std::map<std::string, std::string> fields;
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size()) {
      throw CLI::ValidationError("--compare", "expected STATE=FIELD, found '" + assignment + "'");
    }
    fields[assignment.substr(0, equals)] = assignment.substr(equals + 1);
  }
  return fields;
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code none;  // a file that does not exist is no other file
  return std::filesystem::equivalent(a, b, none);
}

int run(int argc, char** argv) {
  // Takes topic remappings (from:=to, __ns:=...) off the command line, as for every ROS node.
  ros::init(argc, argv, "replay", ros::init_options::AnonymousName | ros::init_options::NoRosout);

  CLI::App app{
      "Runs an observer over a bag, as fast as the machine allows and without roscore, and "
      "compares its estimates with the truth. Remappings (from:=to) hold as for a node."};
  sdo::ReplayOptions options;
  std::vector<std::string> config_files;
  std::vector<std::string> assignments;
  std::vector<double> bounds;
  std::uint64_t seed = 0;
  std::string json_path;
  std::string plot_path;
  app.add_option("bag", options.bag, "Bag to read")->required()->type_name("BAG");
  app.add_option("config", config_files, "Configuration files; a key may stand in one of them only")
      ->required()
      ->type_name("CONFIG");
  app.add_option("-o,--output", options.output,
                 "Bag to write: estimates, event statuses and the messages received");
  app.add_option("--truth", options.truth_topic, "Topic of the truth");
  app.add_option(
      "--compare", assignments,
      "Which field of the truth is which state, as STATE=FIELD; may be given several times "
      "(default for a StateEstimate: every state by its name)");
  CLI::Option* thin =
      app.add_option("--thin", bounds,
                     "Keep a random subset of the samples, T1 to T2 seconds apart; without --truth "
                     "all samples serve as truth")
          ->expected(2)
          ->check(sdo::number_between(1e-9, 1e6))
          ->type_name("T1 T2");
  app.add_option("--seed", seed, "Seed of --thin (default 0)")
      ->check(sdo::whole_number_at_least(0))
      ->needs(thin);
  CLI::Option* from =
      app.add_option("--from", options.from, "Compare from this time on [s after the first truth]")
          ->check(sdo::number_at_least(0));
  CLI::Option* to =
      app.add_option("--to", options.to, "Compare up to this time [s after the first truth]")
          ->check(sdo::number_at_least(0));
  app.add_flag("--no-input", options.may_lack_input,
               "The bag need not have the topic of the input, which is zero then");
  app.add_option("--plot", plot_path,
                 "Draw truth, samples and estimate into this file (.png, .pdf, .svg)")
      ->check(sdo::picture_file());
  app.add_option("--json", json_path, "Write the summary for machines into this file");
  app.footer(
      "Exit status: 0 done, 1 a fault in bag, configuration or files, 2 the truth refutes the "
      "guaranteed error bound, 3 the estimate diverged, else wrong usage.");

  try {
    app.parse(argc, argv);
    options.truth_fields = parse_fields(assignments);
    if (!bounds.empty()) {
      if (bounds[0] > bounds[1]) throw CLI::ValidationError("--thin", "T1 <= T2 must hold");
      options.thinning = sdo::ReplayOptions::Thinning{bounds[0], bounds[1], seed};
    }
    if (!assignments.empty() && options.truth_topic.empty()) {
      throw CLI::ValidationError("--compare", "needs --truth");
    }
    if ((*from || *to) && options.truth_topic.empty() && !options.thinning) {
      throw CLI::ValidationError("--from and --to", "need a truth, by --truth or --thin");
    }
    if (options.from > options.to) {
      throw CLI::ValidationError("--from", "must not be later than --to");
    }
    for (const std::string& written : {options.output, json_path, plot_path}) {
      if (is_same_file(written, options.bag)) {
        throw CLI::ValidationError(written, "is the bag that is read: it would be lost");
      }
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }

  const sdo::ObserverConfig config =
      sdo::read_observer_config(config_files, sdo::load_plant_plugin);
  if (!config.warning.empty()) std::cerr << "replay: " << config.warning << "\n";
  for (const std::string& warning : config.warnings) std::cerr << "replay: " << warning << "\n";
  const sdo::ReplaySummary summary = sdo::replay(config, options);
  sdo::print_table(summary, std::cout);
  if (!json_path.empty()) sdo::write_json(summary, json_path);
  if (!plot_path.empty()) sdo::draw_plot(summary, plot_path);
  if (summary.is_guarantee_broken()) return kGuaranteeBroken;
  return summary.diverged.empty() ? 0 : kDiverged;
}

}  // namespace

int main(int argc, char** argv) {
  return sampled_data_observers::tool_main("replay", run, argc, argv);
}
