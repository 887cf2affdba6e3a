#include "design/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "config/design_config.h"
#include "console/json_text.h"
#include "console/option_checks.h"
#include "console/output_checks.h"
#include "console/plot_program.h"
#include "console/progress_bar.h"
#include "design/paragraphs.h"
#include "design/sweep_folder.h"
#include "design/workers.h"
#include "files/csv.h"
#include "messages/plant_plugins.h"
#include "tools/design/claims.h"
#include "tools/design/commands.h"
#include "tools/design/design_page.h"
#include "tools/design/gain_files.h"

namespace sampled_data_observers {
namespace {

/// Where the plant file has one time between samples only, T2 begins at this part of it.
constexpr double kShortest = 0.1;
/// From this ratio of values on, they are drawn on a logarithmic axis.
constexpr double kLogarithmicFrom = 8.0;

/// Formats of the curves.
constexpr std::array<const char*, 2> kPictures = {"png", "svg"};

/// Of the page, in the folder.
constexpr char kPage[] = "/report.html";

struct SweepArguments {
  std::vector<std::string> files;
  std::vector<std::string> methods;
  std::string objective;
  std::string output;
  std::optional<std::array<double, 2>> T2;  // [s]
  std::optional<double> T1;                 // [s]
  std::size_t points = 20;
  std::vector<std::string> assignments;
  unsigned jobs = default_jobs();
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

/// Points that have a design, which another one with a longer T2 beats.
nlohmann::json candidates_beside(const std::vector<CurvePoint>& curves,
                                 const std::vector<SweepPoint>& points, const std::string& method) {
  nlohmann::json x = nlohmann::json::array();
  nlohmann::json y = nlohmann::json::array();
  for (const CurvePoint& curve : curves) {
    if (curve.method != method || curve.design.T2 == curve.T2) continue;
    for (const SweepPoint& point : points) {
      if (point.method != method || point.T2 != curve.T2 || !point.value) continue;
      x.push_back(point.T2);
      y.push_back(*point.value);
    }
  }
  return {{"x", x}, {"y", y}};
}

nlohmann::json chart_of(const SweepRequest& request, const std::vector<CurvePoint>& curves,
                        const std::vector<SweepPoint>& points, const SweepArguments& arguments) {
  nlohmann::json json;
  json["title"] = arguments.files.front();
  for (const auto& [name, value] : request.given) {
    json["title"] =
        json["title"].get<std::string>() + ", " + name + " = " + shortest_decimal(value);
  }
  json["x_label"] = "$T_2$, longest time between samples [s]";
  json["y_label"] = drawn_quantity(*request.methods.front(), request.subject, request.objective);
  json["curves"] = nlohmann::json::array();
  double least = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (const DesignMethod* method : request.methods) {
    nlohmann::json x = nlohmann::json::array();
    nlohmann::json y = nlohmann::json::array();
    nlohmann::json crosses = nlohmann::json::array();
    for (const CurvePoint& point : curves) {
      if (point.method != method->name()) continue;
      if (point.design.value) {
        x.push_back(point.T2);
        y.push_back(*point.design.value);
        least = std::min(least, *point.design.value);
        largest = std::max(largest, *point.design.value);
      } else {
        crosses.push_back(point.T2);
      }
    }
    json["curves"].push_back({{"label", method->name()},
                              {"x", x},
                              {"y", y},
                              {"crosses", crosses},
                              {"candidates", candidates_beside(curves, points, method->name())}});
  }
  json["logarithmic"] = largest > kLogarithmicFrom * least;
  return json;
}

/// Every point, with what it was made with or why there is no design.
PageTable candidates_of(const std::vector<SweepPoint>& points) {
  PageTable table;
  table.title = "Candidates";
  table.note = "The best design of each method for each longest time between samples.";
  table.heads = {"method", "T2 [s]",   "value",
                 "with",   "took [s]", "gain file, or why there is none"};
  table.texts = {0, 3, 5};
  for (const SweepPoint& point : points) {
    std::string parameters;
    for (const auto& [name, value] : point.parameters) {
      parameters += (parameters.empty() ? "" : ", ") + name + " = " + brief(value);
    }
    table.rows.push_back({point.method, shortest_decimal(point.T2),
                          point.value ? brief(*point.value) : "", parameters, brief(point.seconds),
                          point.value ? SweepFolder::gain_file(point) : point.message});
  }
  std::sort(table.rows.begin(), table.rows.end(), [](const auto& first, const auto& second) {
    return std::make_pair(first[0], std::stod(first[1])) <
           std::make_pair(second[0], std::stod(second[1]));
  });
  return table;
}

void draw(const SweepRequest& request, const std::vector<CurvePoint>& curves,
          const std::vector<SweepPoint>& points, const SweepArguments& arguments) {
  nlohmann::json json = chart_of(request, curves, points, arguments);
  for (const char* ending : kPictures) {
    run_plot_program("plot_curves", json_text(json), arguments.output + "/curve." + ending);
  }
  DesignPage page;
  page.title = "Sweep of " + json["title"].get<std::string>();
  page.subtitle = std::string("Objective ") + to_string(request.objective) +
                  ", T1 = " + shortest_decimal(request.subject.T1) + " s.";
  json["marks"] = true;
  json["heading"] = "Frontier";
  json["note"] =
      "The best design of each method for each longest time between samples. A design for a longer "
      "one serves for a shorter one, too.";
  page.charts.push_back(std::move(json));
  page.tables.push_back(candidates_of(points));
  write_page(page, arguments.output + kPage);
}

void print_summary(const SweepRequest& request, const std::vector<CurvePoint>& curves) {
  std::printf("%-34s %8s  %12s  %s\n", "method", "designs", "largest T2",
              request.objective == Objective::kMinGamma ? "gain at least and largest T2"
                                                        : "rate at least and largest T2");
  for (const DesignMethod* method : request.methods) {
    std::vector<const CurvePoint*> designs;
    std::size_t points = 0;
    for (const CurvePoint& point : curves) {
      if (point.method != method->name()) continue;
      ++points;
      if (point.design.value) designs.push_back(&point);
    }
    const std::string count = std::to_string(designs.size()) + "/" + std::to_string(points);
    if (designs.empty()) {
      std::printf("%-34s %8s\n", method->name().c_str(), count.c_str());
      continue;
    }
    std::printf("%-34s %8s  %10.6g s  %.4g ... %.4g\n", method->name().c_str(), count.c_str(),
                designs.back()->T2, *designs.front()->design.value, *designs.back()->design.value);
  }
}

void refuse_overwriting(const SweepArguments& arguments, const SweepRequest& request) {
  std::vector<GivenFile> outputs;
  const auto add = [&](const std::string& name) {
    outputs.push_back({"--output", arguments.output + "/" + name});
  };
  for (const std::string& name : SweepFolder::tables()) add(name);
  for (const char* ending : kPictures) add(std::string("curve.") + ending);
  outputs.push_back({"--output", arguments.output + kPage});
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

void sweep_command(const SweepArguments& arguments, const std::string& command_line) {
  const DesignConfig config = read_design_config(arguments.files, load_plant_plugin);
  const SweepRequest request = request_of(arguments, config);
  refuse_overwriting(arguments, request);
  SweepFolder folder(arguments.output, request, config.plant_hash);
  forget_lost_designs(arguments, folder);
  const GainFileOrigin origin = origin_of(arguments.output + "/gains/design.yaml",
                                          arguments.files.front(), config.plant_hash, command_line);
  note_interruptions();
  SweepOptions options;
  options.jobs = arguments.jobs;
  options.time_limit = arguments.time_limit;
  options.is_done = [&](const std::string& method, double T2) { return folder.has(method, T2); };
  options.is_cancelled = [] { return interrupted != 0; };
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
  folder.write_curve();
  const std::vector<CurvePoint> curves = best_curves(folder.points(), request.objective);
  draw(request, curves, folder.points(), arguments);
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
  command.option("--jobs NUMBER", arguments->jobs, "Points at a time, as many as processors")
      .check(whole_number_at_least(1));
  command.option("--time-limit SECONDS", arguments->time_limit, "For one attempt [s]")
      .check(number_at_least(0));
  command.action([arguments, command_line] {
    sweep_command(*arguments, command_line);
    return 0;
  });
}

}  // namespace sampled_data_observers
