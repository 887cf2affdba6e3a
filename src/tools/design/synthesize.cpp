#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/design_config.h"
#include "console/option_checks.h"
#include "console/output_checks.h"
#include "design/analysis.h"
#include "design/assumed_disturbance.h"
#include "design/best_design.h"
#include "design/final_error.h"
#include "design/request_error.h"
#include "design/run_time_proof.h"
#include "design/synthesis.h"
#include "design/workers.h"
#include "linear_algebra/matrix_functions.h"
#include "messages/plant_plugins.h"
#include "tools/design/commands.h"
#include "tools/design/cross_check.h"
#include "tools/design/event_time_options.h"
#include "tools/design/gain_files.h"
#include "tools/design/run_time_report.h"

namespace sampled_data_observers {
namespace {

struct SynthesizeArguments {
  std::vector<std::string> files;
  std::string method;
  std::string objective;
  std::string output;
  EventTimeArguments times;
  std::vector<std::string> assignments;
  std::vector<std::string> searched;
  unsigned jobs = default_jobs();
  double time_limit = 20.0;
  std::string sdpa;
  std::string cross_check;
};

/// Where only its bound keeps a gain small, the estimate may be of little use in noise.
void note_gains_near_their_bound(const Design& design) {
  constexpr double kNear = 0.8;
  const auto bound = design.parameters.find("gain_bound");
  if (bound == design.parameters.end()) return;
  const Certificate& certificate = design.certificate;
  for (const NamedShape& shape : certificate.theorem->gains(certificate.subject)) {
    if (shape.name.front() != 'L') continue;  // the others have no bound
    const double norm = norm2(certificate.values.at(shape.name));
    if (norm < kNear * bound->second) continue;
    std::printf(
        "note: the norm of %s, %.4g, is near gain_bound = %.4g: hardly anything else limits it. A "
        "smaller bound\n(--set gain_bound=NUMBER) makes the estimate less sensitive to noise.\n",
        shape.name.c_str(), norm, bound->second);
  }
}

DesignProblem read_problem(const SynthesizeArguments& arguments, const DesignConfig& config,
                           const DesignMethod* method) {
  DesignProblem problem;
  problem.subject = config.subject;
  take_event_times(arguments.times, problem.subject);
  if (problem.subject.T2 <= 0.0) {
    throw DesignError("the times between samples are missing: give --T2, or design/sampling in " +
                      arguments.files.front());
  }
  problem.given = parameters_for(method, problem.subject, config.parameters);
  for (const std::string& assignment : arguments.assignments) assign(assignment, problem.given);
  if (method == nullptr) parameters_for(nullptr, problem.subject, problem.given);
  problem.searched.insert(arguments.searched.begin(), arguments.searched.end());
  return problem;
}

/// With what an objective is about, where that is not the bound on the final error.
void print_outcomes(const std::vector<MethodOutcome>& outcomes, Objective objective,
                    bool is_weighted) {
  const char* figure = "";
  if (objective == Objective::kMaxT2) figure = "T2 [s]";
  if (objective == Objective::kMinT1) figure = "T1 [s]";
  if (objective == Objective::kMaxDecay) figure = "1/100 after [s]";
  std::printf("  %-36s %-16s %s\n", "method", figure,
              is_weighted ? "bound on the weighted final error" : "bound on the final error");
  for (const MethodOutcome& outcome : outcomes) {
    if (!outcome.design) {
      const std::string first_line = outcome.message.substr(0, outcome.message.find('\n'));
      std::printf("  %-36s %s\n", outcome.method.c_str(), first_line.c_str());
      continue;
    }
    char number[32] = "";
    if (objective == Objective::kMaxT2) {
      std::snprintf(number, sizeof number, "%.6g", outcome.design->certificate.subject.T2);
    }
    if (objective == Objective::kMinT1) {
      std::snprintf(number, sizeof number, "%.6g", outcome.design->certificate.subject.T1);
    }
    if (objective == Objective::kMaxDecay) {
      std::snprintf(number, sizeof number, "%.6g", outcome.time_to_hundredth);
    }
    std::printf("  %-36s %-16s ", outcome.method.c_str(), number);
    if (std::isfinite(outcome.final_error)) {
      std::printf("%.6g\n", outcome.final_error);
    } else {
      std::printf("none for this noise and disturbance\n");
    }
  }
}

/// Why no theorem is about several sensors of a plant.
std::string cause_for_several_sensors(const CertificateSubject& subject) {
  const char* const name = "timer_dependent_scheduled_gain";
  try {
    require_subject(*find_theorem(name), subject);
  } catch (const std::invalid_argument& fault) {
    return std::string(", with several sensors (") + name + ": " + fault.what() + ")";
  }
  return ", with several sensors";
}

/// Tries all methods that apply, and says so.
Design best_design(const DesignProblem& problem, const SynthesisOptions& options) {
  const std::vector<const DesignMethod*> methods = methods_that_apply(problem);
  if (methods.empty()) {
    std::string cause;
    if (problem.subject.dwell_time) {
      cause = ", with a dwell time in place of T1 and T2";
    } else if (std::isinf(problem.subject.T2)) {
      cause = ", with T2 = inf";
    } else if (problem.subject.plant.sampled.size() > 1) {
      cause = cause_for_several_sensors(problem.subject);
    }
    throw RequestError(std::string("no method serves the objective ") +
                       to_string(problem.objective) + " for this plant" + cause +
                       ": --method NAME says why that one does not");
  }
  const std::vector<MethodOutcome> outcomes = synthesize_by_all(methods, problem, options);
  const MethodOutcome* best = best_of(outcomes, problem.objective);
  if (best == nullptr) {
    std::string text = "none of the methods that apply found a design";
    for (const MethodOutcome& outcome : outcomes) text += "\n" + outcome.message;
    throw DesignError(text);
  }
  print_outcomes(outcomes, problem.objective, problem.subject.error_weights.size() > 0);
  std::printf("taken: %s\n\n", best->method.c_str());
  return *best->design;
}

/// min-final-error where a method serves it for the plant, else feasible.
Objective default_objective(const DesignProblem& problem, const DesignMethod* method) {
  DesignProblem least = problem;
  least.objective = Objective::kMinFinalError;
  if (method == nullptr) {
    return methods_that_apply(least).empty() ? Objective::kFeasible : least.objective;
  }
  const auto objectives = method->objectives(problem.subject);
  const bool serves =
      std::find(objectives.begin(), objectives.end(), least.objective) != objectives.end();
  return serves ? least.objective : Objective::kFeasible;
}

/// @throws RequestError where neither noise nor disturbance limits the gains
void require_something_to_weigh(const DeclaredAssumptions& declared) {
  const bool has_disturbance = declared.disturbance.value_or(0.0) > 0.0;
  if (has_disturbance || declared.noise.value_or(1.0) > 0.0) return;
  throw RequestError(
      "error_assumptions: expected a noise or a disturbance larger than 0 for the objective "
      "min-final-error, found noise: 0 and no disturbance; declare what the sensor or the plant is "
      "off by, or take another --objective");
}

/// What commands begin with, where they are to run in the environment that this one runs in:
/// nothing where that is the shell's own.
std::string command_prefix() {
  const char* const run = std::getenv("SDO_RUN");  // set by scripts/run
  return run == nullptr ? "" : std::string(run) + " ";
}

/// How an observer with these gains is started, and what its error bound takes.
void print_how_to_run(const SynthesizeArguments& arguments, const DeclaredAssumptions& declared,
                      bool has_held_outputs) {
  std::string files;
  std::string absolute;  // roslaunch starts nodes in a folder of its own
  for (const std::string& file : arguments.files) {
    files += file + " ";
    absolute += std::filesystem::absolute(file).string() + " ";
  }
  const std::string prefix = command_prefix();
  std::printf(
      "To run it:\n"
      "  %srosrun sampled_data_observers replay BAG %s%s\n"
      "  %sroslaunch sampled_data_observers observer.launch config:=\"%s%s\"\n",
      prefix.c_str(), files.c_str(), arguments.output.c_str(), prefix.c_str(), absolute.c_str(),
      std::filesystem::absolute(arguments.output).c_str());
  if (declared.noise) return;
  std::printf(
      "For a bound on the error, say how noisy the sensor is, in %s, and design again:\n"
      "error_assumptions: {initial_error: NUMBER, noise: NUMBER%s}\n",
      arguments.files.front().c_str(), has_held_outputs ? ", output_rate: NUMBER" : "");
}

void synthesize_command(const SynthesizeArguments& arguments, const std::string& command_line) {
  refuse_overwriting(given_files("PLANT", arguments.files),
                     {{"--output", arguments.output}, {"--sdpa", arguments.sdpa}});
  const DesignConfig config = read_design_config(arguments.files, load_plant_plugin);
  const GainFileOrigin origin =
      origin_of(arguments.output, arguments.files.front(), config.plant_hash, command_line);
  const DesignMethod* method = find_design_method(arguments.method);
  DesignProblem problem = read_problem(arguments, config, method);
  DesignProblem assumed = problem;
  DeclaredAssumptions declared = {config.noise, config.disturbance};
  if (method != nullptr && !declared.disturbance && !bounds_disturbances(method->theorem())) {
    declared.disturbance = 0.0;
  }
  assume(declared, assumed);
  problem.assumptions = assumed.assumptions;
  problem.objective = arguments.objective.empty() ? default_objective(assumed, method)
                                                  : objective_of(arguments.objective);
  if (problem.objective == Objective::kMinFinalError) {
    require_something_to_weigh(declared);
    assumed.objective = problem.objective;
    problem = assumed;
    print_assumptions(declared, problem, config.plant->state_names());
  } else if (arguments.objective.empty()) {
    std::printf(
        "Any gains whose proof is far from its edge (--objective feasible): %s is not for "
        "%s.\n",
        to_string(Objective::kMinFinalError),
        method == nullptr ? "this plant" : method->name().c_str());
  }

  SynthesisOptions options;
  options.jobs = arguments.jobs;
  options.time_limit = arguments.time_limit;
  Design design;
  try {
    design =
        method == nullptr ? best_design(problem, options) : synthesize(*method, problem, options);
  } catch (const RequestError&) {
    throw;
  } catch (const DesignError& error) {
    std::fprintf(stderr, "design: %s\n", error.what());
    throw ExitStatus{kNoDesign};
  }
  if (problem.objective != Objective::kMinFinalError) {
    design.for_run_time = prove_for_run_time(design, assumed.assumptions, options);
  }
  const std::string text = save_gain_file(design, origin, arguments.output);
  std::printf("%s\nwritten to %s after %zu attempt%s in %.1f s\n", abridged_gain_file(text).c_str(),
              arguments.output.c_str(), design.attempts, design.attempts == 1 ? "" : "s",
              design.seconds);
  print_run_time_figures(design, assumed.assumptions);
  note_gains_near_their_bound(design);
  print_how_to_run(arguments, {config.noise, config.disturbance},
                   config.plant->outputs(SensorTiming::kContinuous) > 0);
  if (!arguments.sdpa.empty()) {
    write_sdpa(*find_design_method(design.method), design, arguments.sdpa);
    std::printf("the semidefinite program is in %s\n", arguments.sdpa.c_str());
  }
  if (!arguments.cross_check.empty()) {
    cross_check(*find_design_method(design.method), design, arguments.time_limit);
  }
}

}  // namespace

void add_synthesize(CommandLine& tool, const std::string& command_line) {
  CommandLine& command = tool.command("synthesize", "Find gains for a plant, with their proof");
  auto arguments = std::make_shared<SynthesizeArguments>();
  std::vector<std::string> methods;
  std::string help = "How to design (default: by all that apply, of which the best is taken):";
  for (const DesignMethod* method : design_methods()) {
    methods.push_back(method->name());
    help += "\n  " + method->name() + ": " + method->summary();
  }
  command.argument("PLANT...", arguments->files, "Files with plant, sensors and design");
  command.option("-o, --output FILE", arguments->output, "Gain file to write").required();
  command.option("--method NAME", arguments->method, help).check(one_of(methods));
  command
      .option("--objective NAME", arguments->objective,
              "What to look for (default: min-final-error, or feasible where that is not for the "
              "method)")
      .choices({"min-final-error", "feasible", "min-gamma", "max-T2", "min-T1", "max-decay"});
  add_event_times(command, "design/sampling", arguments->times);
  command.option("--set NAME=NUMBER...", arguments->assignments,
                 "Fix a parameter of the method; may be given several times");
  command.option(
      "--search NAME...", arguments->searched,
      "Search for a parameter that has a default, such as a; may be given several times");
  command.option("--jobs NUMBER", arguments->jobs, "Solvers at a time, as many as processors")
      .check(whole_number_at_least(1));
  command.option("--time-limit SECONDS", arguments->time_limit, "For one attempt [s]")
      .check(number_at_least(0));
  command.option("--sdpa FILE", arguments->sdpa,
                 "Write the design's semidefinite program in the SDPA sparse format (.dat-s)");
  command
      .option("--cross-check sdpa", arguments->cross_check,
              "Solve the design's semidefinite program with a second solver, too, and compare the "
              "objectives")
      .check(one_of({"sdpa"}));
  command.action([arguments, command_line] {
    synthesize_command(*arguments, command_line);
    return 0;
  });
}

}  // namespace sampled_data_observers
