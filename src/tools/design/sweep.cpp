#include "design/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/design_config.h"
#include "console/option_checks.h"
#include "console/output_checks.h"
#include "console/progress_bar.h"
#include "design/sweep_folder.h"
#include "design/workers.h"
#include "files/csv.h"
#include "messages/plant_plugins.h"
#include "ranks/ranks.h"
#include "tools/design/claims.h"
#include "tools/design/commands.h"
#include "tools/design/gain_files.h"
#include "tools/design/sweep_results.h"

namespace sampled_data_observers {
namespace {

/// Where the plant file has one time between samples only, T2 begins at this part of it.
constexpr double kShortest = 0.1;

struct SweepArguments {
  std::vector<std::string> files;
  std::vector<std::string> methods;
  std::string objective;
  std::string output;
  std::optional<std::array<double, 2>> T2;  // [s]
  std::optional<double> T1;                 // [s]
  std::size_t points = 20;
  std::vector<std::string> assignments;
  std::optional<unsigned> jobs;
  double time_limit = 20.0;
};

volatile std::sig_atomic_t interrupted = 0;

/// From here on, Ctrl-C (and the end that a system sends) is noted; a second one ends at once.
void note_interruptions() {
  struct sigaction action = {};
  action.sa_handler = [](int) { interrupted = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

Objective objective_for(const SweepArguments& arguments, const CertificateSubject& subject) {
  if (!arguments.objective.empty()) return objective_of(arguments.objective);
  return methods_for(subject, Objective::kMinGamma).empty() ? Objective::kMaxDecay
                                                            : Objective::kMinGamma;
}

SweepRequest request_of(const SweepArguments& arguments, const DesignConfig& config) {
  if (config.subject.plant.sampled.size() > 1) {
    throw DesignError(
        "a sweep is over the one longest time between samples, but several sensors are sampled, "
        "each at times of its own: `design synthesize` designs for them");
  }
  SweepRequest request;
  request.subject = config.subject;
  double low = 0.0;
  double high = 0.0;
  if (arguments.T2) {
    low = arguments.T2->front();
    high = arguments.T2->back();
  } else if (config.subject.T2 > 0.0 && std::isfinite(config.subject.T2)) {
    high = config.subject.T2;
    low = config.subject.T1 < high ? config.subject.T1 : kShortest * high;
  } else {
    throw DesignError(
        "a longest time between samples is missing: give --T2 LOW HIGH, or "
        "design/sampling in " +
        arguments.files.front());
  }
  request.T2 = sweep_times(low, high, arguments.points);
  const double T1 = arguments.T1.value_or(config.subject.T1);
  if (arguments.T1 && T1 > request.T2.front()) {
    throw DesignError("T1 = " + shortest_decimal(T1) + " s: expected at most the least T2, " +
                      shortest_decimal(request.T2.front()) + " s");
  }
  request.subject.T1 = T1 > 0.0 ? std::min(T1, request.T2.front()) : request.T2.front();
  request.subject.T2 = request.T2.back();
  request.subject.dwell_time.reset();
  request.objective = objective_for(arguments, request.subject);
  for (const std::string& name : arguments.methods) {
    request.methods.push_back(find_design_method(name));
  }
  if (request.methods.empty()) request.methods = methods_for(request.subject, request.objective);
  if (request.methods.empty()) {
    throw DesignError(std::string("no method serves the objective ") +
                      to_string(request.objective) +
                      " for this plant; `design explain` tells why not");
  }
  request.given = config.parameters;
  for (const std::string& assignment : arguments.assignments) assign(assignment, request.given);
  require_sense(request);
  return request;
}

void refuse_overwriting(const SweepArguments& arguments, const SweepRequest& request) {
  std::vector<GivenFile> outputs;
  const auto add = [&](const std::string& name) {
    outputs.push_back({"--output", arguments.output + "/" + name});
  };
  for (const std::string& name : SweepFolder::tables()) add(name);
  for (const std::string& name : names_of_pictures()) add(name);
  for (const DesignMethod* method : request.methods) {
    SweepPoint point;
    point.method = method->name();
    for (const double T2 : request.T2) {
      point.T2 = T2;
      add(SweepFolder::gain_file(point));
    }
  }
  for (const GivenFile& output : outputs) {
    refuse_overwriting(given_files("PLANT", arguments.files), {output});
  }
}

/// Why a gain file is not the one of a point of points.csv; empty where it is.
std::string what_is_lost(const std::string& gain_file, const SweepPoint& point,
                         const std::vector<std::string>& plant_files) {
  try {
    const Certificate certificate = read_claims(gain_file, plant_files).front().certificate;
    if (certificate.subject.T2 != point.T2) return gain_file + ": it is for another T2";
    return all_hold(check(certificate)) ? "" : gain_file + ": its certificate does not hold";
  } catch (const std::exception& fault) {
    return fault.what();
  }
}

/// What was finished is tried again where its gain file is not what it was.
void forget_lost_designs(const SweepArguments& arguments, SweepFolder& folder) {
  const std::vector<SweepPoint> points = folder.points();
  for (const SweepPoint& point : points) {
    if (!point.value) continue;
    const std::string fault = what_is_lost(arguments.output + "/" + SweepFolder::gain_file(point),
                                           point, arguments.files);
    if (fault.empty()) continue;
    std::fprintf(stderr, "design: %s\ndesign: it was finished, and is computed anew\n",
                 fault.c_str());
    folder.forget(point);
  }
}

SweepOptions options_of(const SweepArguments& arguments, Ranks* ranks) {
  SweepOptions options;
  // mpirun starts as many ranks as there are processors.
  options.jobs = arguments.jobs.value_or(ranks == nullptr ? default_jobs() : 1);
  options.time_limit = arguments.time_limit;
  options.is_cancelled = [] { return interrupted != 0; };
  options.ranks = ranks;
  return options;
}

/// On all ranks but the first, which keeps and shows the results.
void take_part_in_sweep(const SweepArguments& arguments, Ranks& ranks) {
  const DesignConfig config = read_design_config(arguments.files, load_plant_plugin);
  const SweepRequest request = request_of(arguments, config);
  note_interruptions();
  SweepOptions options = options_of(arguments, &ranks);
  options.request = request_line(request, config.plant_hash);
  try {
    run_sweep(request, options);
  } catch (const Cancelled&) {
    throw ExitStatus{kInterrupted};
  }
  ranks.finish();
}

void sweep_command(const SweepArguments& arguments, const std::string& command_line) {
  Ranks* const ranks = command_ranks();
  if (ranks != nullptr && ranks->rank() > 0) {
    name_rank_in_faults(ranks, [&] { take_part_in_sweep(arguments, *ranks); });
    return;
  }
  const DesignConfig config = read_design_config(arguments.files, load_plant_plugin);
  const SweepRequest request = request_of(arguments, config);
  refuse_overwriting(arguments, request);
  SweepFolder folder(arguments.output, request, config.plant_hash);
  forget_lost_designs(arguments, folder);
  const GainFileOrigin origin = origin_of(arguments.output + "/gains/design.yaml",
                                          arguments.files.front(), config.plant_hash, command_line);
  note_interruptions();
  SweepOptions options = options_of(arguments, ranks);
  options.request = request_line(request, config.plant_hash);
  options.is_done = [&](const std::string& method, double T2) { return folder.has(method, T2); };
  std::size_t lost = 0;
  try {
    ProgressBar progress("sweep", remaining_points(request, options));
    options.on_point = [&](const SweepPoint& point, const Design* design) {
      folder.add(point, design, origin);
      progress.advance();
    };
    lost = run_sweep(request, options);
  } catch (const Cancelled&) {
    folder.write_curve();
    std::fprintf(stderr,
                 "design: interrupted; %zu of %zu points are in %s. The same command goes on.\n",
                 folder.points().size(), request.methods.size() * request.T2.size(),
                 arguments.output.c_str());
    throw ExitStatus{kInterrupted};
  }
  if (ranks != nullptr) ranks->finish();
  folder.write_curve();
  const std::vector<CurvePoint> curves = best_curves(folder.points(), request.objective);
  draw_sweep(request, curves, folder.points(), arguments.files.front(), arguments.output);
  print_summary(request, curves);
  std::printf("written to %s: curve.csv, curve.png, curve.svg, report.html, points.csv, gains/\n",
              arguments.output.c_str());
  if (lost > 0) {
    throw std::runtime_error(std::to_string(lost) +
                             " points were lost with their process; the same command tries again");
  }
  if (std::none_of(curves.begin(), curves.end(),
                   [](const CurvePoint& point) { return point.design.value.has_value(); })) {
    std::fprintf(stderr, "design: no design at any point; points.csv says why\n");
    throw ExitStatus{kNoDesign};
  }
}

}  // namespace

void add_sweep(CommandLine& tool, const std::string& command_line) {
  CommandLine& command = tool.command(
      "sweep", "Trade-off curves: the best designs over the longest time between samples");
  auto arguments = std::make_shared<SweepArguments>();
  std::vector<std::string> names;
  for (const DesignMethod* method : design_methods()) names.push_back(method->name());
  command.argument("PLANT...", arguments->files, "Files with plant, sensors and design");
  command
      .option("-o, --output FOLDER", arguments->output,
              "Folder for curves and gain files; what is finished in it is kept")
      .required();
  command
      .option("--method NAME...", arguments->methods,
              "As for synthesize; may be given several times (default: all that are about the "
              "plant and serve the objective)")
      .check(one_of(names));
  command
      .option("--objective NAME", arguments->objective,
              "What is drawn over T2 (default: min-gamma where the plant has N)")
      .choices({"min-gamma", "max-decay"});
  command
      .option("--T2 LOW HIGH", arguments->T2,
              "Range of T2 [s] (default: design/sampling T1 and T2)")
      .check(number_above(0));
  command
      .option("--T1 SECONDS", arguments->T1,
              "T1 of all designs [s] (default: design/sampling, at most LOW)")
      .check(number_above(0));
  command.option("--points NUMBER", arguments->points, "Number of T2")
      .check(whole_number_between(1, 100000));
  command.option("--set NAME=NUMBER...", arguments->assignments,
                 "Fix a parameter of the methods; may be given several times");
  command
      .option("--jobs NUMBER", arguments->jobs,
              "Points at a time (default: as many as processors, by mpirun one on each rank)")
      .check(whole_number_at_least(1));
  command.option("--time-limit SECONDS", arguments->time_limit, "For one attempt [s]")
      .check(number_at_least(0));
  command.action([arguments, command_line] {
    sweep_command(*arguments, command_line);
    return 0;
  });
}

}  // namespace sampled_data_observers
