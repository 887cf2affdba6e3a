#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "commands.h"
#include "sampled_data_observers/config/design_config.h"
#include "sampled_data_observers/design/gain_file.h"
#include "sampled_data_observers/design/synthesis.h"
#include "sampled_data_observers/design/workers.h"
#include "sampled_data_observers/ros/plant_plugins.h"

namespace sampled_data_observers {
namespace {

struct Arguments {
  std::vector<std::string> files;
  std::string method;
  std::string objective = "feasible";
  std::string output;
  double T1 = 0.0;
  double T2 = 0.0;
  std::vector<std::string> assignments;
  unsigned jobs = default_jobs();
  double time_limit = 20.0;
};

Objective objective_of(const std::string& name) {
  for (const Objective objective :
       {Objective::kMinGamma, Objective::kMaxT2, Objective::kMaxDecay}) {
    if (name == to_string(objective)) return objective;
  }
  return Objective::kFeasible;
}

void assign(const std::string& assignment, Parameters& parameters) {
  const std::size_t equals = assignment.find('=');
  std::size_t used = 0;
  double value = 0.0;
  try {
    if (equals != std::string::npos) value = std::stod(assignment.substr(equals + 1), &used);
  } catch (const std::logic_error&) {
    used = 0;
  }
  if (equals == std::string::npos || equals == 0 || used + equals + 1 != assignment.size()) {
    throw CLI::ValidationError("--set", "expected NAME=NUMBER, found '" + assignment + "'");
  }
  parameters[assignment.substr(0, equals)] = value;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

/// The plant file as the gain file names it: relative to its own folder.
std::string relative_to_output(const std::string& file, const std::string& output) {
  namespace fs = std::filesystem;
  return fs::relative(fs::absolute(file), fs::absolute(output).parent_path()).string();
}

void synthesize_command(const Arguments& arguments, const std::string& command_line) {
  const DesignConfig config = read_design_config(arguments.files, load_plant_plugin);
  DesignProblem problem;
  problem.subject = config.subject;
  if (arguments.T1 > 0.0) problem.subject.T1 = arguments.T1;
  if (arguments.T2 > 0.0) problem.subject.T2 = arguments.T2;
  if (problem.subject.T2 <= 0.0) {
    throw DesignError("the times between samples are missing: give --T2, or design/sampling in " +
                      arguments.files.front());
  }
  if (problem.subject.T1 > problem.subject.T2) throw DesignError("T1 > T2");
  problem.given = config.parameters;
  for (const std::string& assignment : arguments.assignments) assign(assignment, problem.given);
  problem.objective = objective_of(arguments.objective);

  SynthesisOptions options;
  options.jobs = arguments.jobs;
  options.time_limit = arguments.time_limit;
  Design design;
  try {
    design = synthesize(*find_design_method(arguments.method), problem, options);
  } catch (const DesignError& error) {
    std::fprintf(stderr, "design: %s\n", error.what());
    throw ExitStatus{kNoDesign};
  }
  std::ostringstream text;
  write_gain_file(design,
                  {relative_to_output(arguments.files.front(), arguments.output), config.plant_hash,
                   command_line, today()},
                  text);
  std::ofstream file(arguments.output);
  file << text.str();
  file.close();
  if (!file) throw std::runtime_error("cannot write " + arguments.output);
  std::printf("%s\nwritten to %s after %zu attempts in %.1f s\n", text.str().c_str(),
              arguments.output.c_str(), design.attempts, design.seconds);
}

}  // namespace

void add_synthesize(CLI::App& app, const std::string& command_line) {
  CLI::App* command = app.add_subcommand("synthesize", "Find gains for a plant, with their proof");
  auto arguments = std::make_shared<Arguments>();
  std::vector<std::string> methods;
  std::string help = "How to design:";
  for (const DesignMethod* method : design_methods()) {
    methods.push_back(method->name());
    help += "\n  " + method->name() + ": " + method->summary();
  }
  command->add_option("plant", arguments->files, "Files with plant, sensors and design")
      ->required()
      ->type_name("PLANT");
  command->add_option("--method", arguments->method, help)
      ->required()
      ->check(CLI::IsMember(methods));
  command->add_option("-o,--output", arguments->output, "Gain file to write")->required();
  command->add_option("--objective", arguments->objective, "What to look for")
      ->check(CLI::IsMember({"feasible", "min-gamma", "max-T2", "max-decay"}));
  command->add_option("--T1", arguments->T1, "Instead of design/sampling/T1 [s]");
  command->add_option("--T2", arguments->T2, "Instead of design/sampling/T2 [s]");
  command->add_option("--set", arguments->assignments,
                      "Fix a parameter of the method, NAME=NUMBER; may be given several times");
  command->add_option("--jobs", arguments->jobs, "Solvers at a time (default: all processors)");
  command->add_option("--time-limit", arguments->time_limit, "For one attempt [s]");
  command->callback([arguments, command_line] { synthesize_command(*arguments, command_line); });
}

}  // namespace sampled_data_observers
