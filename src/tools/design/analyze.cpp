#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "config/certificate_config.h"
#include "config/claimed_gains.h"
#include "config/design_config.h"
#include "config/law_config.h"
#include "config/sampling_config.h"
#include "console/option_checks.h"
#include "console/output_checks.h"
#include "design/analysis.h"
#include "design/assumed_disturbance.h"
#include "design/request_error.h"
#include "design/run_time_proof.h"
#include "design/workers.h"
#include "messages/plant_plugins.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "tools/design/commands.h"
#include "tools/design/event_time_options.h"
#include "tools/design/gain_files.h"
#include "tools/design/run_time_report.h"

namespace sampled_data_observers {
namespace {

struct AnalyzeArguments {
  std::string gains;
  std::vector<std::string> plant;
  std::string theorem;
  std::string objective;
  std::string output;
  EventTimeArguments times;
  std::vector<std::string> assignments;
  unsigned jobs = default_jobs();
  double time_limit = 20.0;
};

/// All theorems: those that a design for the least gain would prove first, then those of other
/// designs.
std::vector<const Theorem*> in_order_of_use(const CertificateSubject& subject) {
  std::vector<const Theorem*> all = theorems();
  const auto rank = [&](const Theorem* theorem) {
    int best = 2;
    for (const DesignMethod* method : design_methods()) {
      if (&method->theorem() != theorem) continue;
      const auto objectives = method->objectives(subject);
      const bool has_gain =
          std::find(objectives.begin(), objectives.end(), Objective::kMinGamma) != objectives.end();
      best = std::min(best, has_gain ? 0 : 1);
    }
    return best;
  };
  std::stable_sort(all.begin(), all.end(), [&](const Theorem* first, const Theorem* second) {
    return rank(first) < rank(second);
  });
  return all;
}

const Theorem& theorem_for(ConfigSection& root, const std::string& name,
                           const CertificateSubject& subject, const LawGains& law) {
  if (!name.empty()) return *find_theorem(name);
  const std::string type = root.text("observer");
  std::string reasons;
  for (const Theorem* theorem : in_order_of_use(subject)) {
    const auto types = theorem->observer_types();
    if (std::find(types.begin(), types.end(), type) == types.end()) continue;
    try {
      require_subject(*theorem, subject);
      const std::vector<std::string> beside = gains_beside(*theorem, subject, law);
      if (beside.empty()) return *theorem;
      throw std::invalid_argument("it is not about gains/" + beside.front());
    } catch (const std::invalid_argument& fault) {
      reasons += (reasons.empty() ? "" : "; ") + theorem->name() + ": " + fault.what();
    }
  }
  throw root.error("observer", "an observer that a theorem is about, for this plant",
                   type + (reasons.empty() ? "" : " (" + reasons + ")"));
}

/// Keeps what the theorem knows of the parameters.
void take(const Parameters& parameters, const Theorem& theorem, AnalysisProblem& problem) {
  for (const NamedShape& shape : theorem.parameters(problem.subject)) {
    const auto found = parameters.find(shape.name);
    if (found != parameters.end()) problem.given[shape.name] = found->second;
  }
}

/// What a certificate claims in numbers: all parameters but those that only help to prove it. The
/// gain is what is asked for.
Parameters claimed(const Certificate& certificate) {
  Parameters parameters;
  for (const NamedShape& shape : certificate.theorem->parameters(certificate.subject)) {
    parameters[shape.name] = scalar_value(certificate.values, shape.name);
  }
  for (const NamedRange& range : certificate.theorem->search_ranges(certificate.subject)) {
    parameters.erase(range.name);
  }
  parameters.erase("gamma");
  return parameters;
}

AnalysisProblem read_problem(const AnalyzeArguments& arguments, const DesignConfig& config) {
  const ConfigNode tree = read_yaml_file(arguments.gains);
  ConfigSection root(tree, "");
  AnalysisProblem problem;
  problem.subject = config.subject;
  const LawGains law = read_law(root, {config.plant, config.names})->observer().gains();
  const auto claim = read_certificate(root, *config.plant, law);
  if (claim) {
    problem.subject = claim->certificate.subject;
  } else if (root.has("sampling")) {
    const SamplingConfig sampling = read_sampling_section(root, *config.plant);
    require_sampling(root, *config.plant, sampling);
    take_sampling(sampling, problem.subject);
  }
  take_event_times(arguments.times, problem.subject);
  if (!(problem.subject.T2 > 0.0)) {
    throw root.error("sampling", "times between events, here or by --T1 and --T2", "none");
  }
  problem.theorem = claim && arguments.theorem.empty()
                        ? claim->certificate.theorem
                        : &theorem_for(root, arguments.theorem, problem.subject, law);
  take(config.parameters, *problem.theorem, problem);
  if (claim) take(claimed(claim->certificate), *problem.theorem, problem);
  for (const std::string& assignment : arguments.assignments) assign(assignment, problem.given);
  const ConfigSection gains = root.section("gains");
  problem.gains = gains_of_theorem(gains, *problem.theorem, problem.subject, law);
  if (const auto error = objection_to_gains(gains, *problem.theorem, problem.subject, law)) {
    throw ConfigError(*error);
  }
  return problem;
}

void print_result(Objective objective, const Design& design) {
  const Certificate& certificate = design.certificate;
  const Theorem& theorem = *certificate.theorem;
  std::printf("  %-9s", to_string(objective));
  const char* separator = "  ";
  for (const NamedShape& shape : theorem.parameters(certificate.subject)) {
    std::printf("%s%s = %.6g", separator, shape.name.c_str(),
                scalar_value(certificate.values, shape.name));
    separator = ", ";
  }
  const auto& dwell_time = certificate.subject.dwell_time;
  if (objective == Objective::kMinT1) {
    std::printf("%sT1 = %.6g s", separator, certificate.subject.T1);
    separator = ", ";
  }
  std::printf(dwell_time ? "%stau = %.6g s\n" : "%sT2 = %.6g s\n", separator,
              dwell_time ? dwell_time->tau : certificate.subject.T2);
  if (design.search_ended) {
    std::printf("             the search ended here: no largest or least value was found\n");
  }
}

void analyze_command(const AnalyzeArguments& arguments, const std::string& command_line) {
  const std::vector<std::string> files = plant_files_of(arguments.gains, arguments.plant);
  std::vector<GivenFile> inputs = given_files("PLANT", files);
  inputs.push_back({"GAINS", arguments.gains});
  refuse_overwriting(inputs, {{"--output", arguments.output}});
  const DesignConfig config = read_design_config(files, load_plant_plugin);
  AnalysisProblem problem = read_problem(arguments, config);
  GainFileOrigin origin;
  if (!arguments.output.empty()) {
    origin = origin_of(arguments.output, files.front(), config.plant_hash, command_line);
  }
  std::vector<Objective> objectives = {objective_of(arguments.objective)};
  if (arguments.objective.empty()) {
    objectives = analysis_objectives(*problem.theorem, problem.subject);
  }
  if (objectives.front() == Objective::kMinFinalError) {
    DesignProblem assumed;
    assumed.subject = problem.subject;
    assume({config.noise, config.disturbance}, assumed);
    problem.subject = assumed.subject;
    problem.assumptions = assumed.assumptions;
  }
  SynthesisOptions options;
  options.jobs = arguments.jobs;
  options.time_limit = arguments.time_limit;

  std::printf("%s: %s\n", problem.theorem->name().c_str(), problem.theorem->guarantee().c_str());
  std::optional<Design> main;
  for (const Objective objective : objectives) {
    problem.objective = objective;
    try {
      const Design found = analyze(problem, options);
      print_result(objective, found);
      if (!main) main = found;
    } catch (const RequestError&) {
      throw;
    } catch (const DesignError& error) {
      std::printf("  %-9s  no proof: %s\n", to_string(objective), error.what());
    }
  }
  if (!main) throw ExitStatus{kNoDesign};
  DesignProblem assumed;
  assumed.subject = problem.subject;
  assume({config.noise, config.disturbance}, assumed);
  if (main->objective != Objective::kMinFinalError) {
    main->for_run_time = prove_for_run_time(*main, assumed.assumptions, options);
  }
  print_run_time_figures(*main, assumed.assumptions);
  if (arguments.output.empty()) return;
  save_gain_file(*main, origin, arguments.output);
  std::printf("written to %s\n", arguments.output.c_str());
}

}  // namespace

void add_analyze(CommandLine& tool, const std::string& command_line) {
  CommandLine& command = tool.command(
      "analyze", "Find what can be proved of given gains: least gain, fastest rate, largest T2");
  auto arguments = std::make_shared<AnalyzeArguments>();
  std::vector<std::string> names;
  for (const Theorem* theorem : theorems()) names.push_back(theorem->name());
  command.argument("GAINS", arguments->gains, "Gain file, with or without certificate");
  command.option("--plant PLANT...", arguments->plant,
                 "Files with the plant, instead of the one that the gain file names");
  command
      .option("--theorem NAME", arguments->theorem,
              "Instead of the one of the certificate, or of the first one that is about the "
              "observer type and the plant")
      .choices(names);
  command
      .option("--objective NAME", arguments->objective,
              "What to look for (default: all that have a meaning)")
      .choices({"feasible", "min-gamma", "max-T2", "min-T1", "max-decay", "min-final-error"});
  command.option("-o, --output FILE", arguments->output,
                 "Gain file to write, with the first of the proofs found");
  add_event_times(command, "the gain file", arguments->times);
  command.option("--set NAME=NUMBER...", arguments->assignments,
                 "Fix a parameter of the theorem; may be given several times");
  command.option("--jobs NUMBER", arguments->jobs, "Solvers at a time, as many as processors")
      .check(whole_number_at_least(1));
  command.option("--time-limit SECONDS", arguments->time_limit, "For one attempt [s]")
      .check(number_at_least(0));
  command.action([arguments, command_line] {
    analyze_command(*arguments, command_line);
    return 0;
  });
}

}  // namespace sampled_data_observers
