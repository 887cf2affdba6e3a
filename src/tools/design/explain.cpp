#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/design_config.h"
#include "console/json_text.h"
#include "console/option_checks.h"
#include "console/output_checks.h"
#include "console/plot_program.h"
#include "design/design_method.h"
#include "design/explained_trajectory.h"
#include "design/explanation.h"
#include "messages/plant_plugins.h"
#include "observer/original_high_gain_observer.h"
#include "observer/transformed_high_gain_observer.h"
#include "sampled_data_observers/config/observer_config.h"
#include "simulation/scenario_config.h"
#include "tools/design/commands.h"
#include "tools/design/design_page.h"
#include "tools/design/event_time_options.h"
#include "tools/design/simulated_trajectory.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kTrajectorySteps = 1000;

struct ExplainArguments {
  std::vector<std::string> files;
  std::optional<double> T1;  // [s]
  std::string T2;            // [s], or inf
  std::string plot;
  std::string report;
  bool along = false;
  std::vector<std::string> gains;
};

/// Nothing where no output is sampled or measured at jumps.
nlohmann::json observability_chart(const CertificateSubject& subject,
                                   const ExplainArguments& arguments) {
  const std::vector<ObservabilityCurve> curves = observability_curves(subject);
  if (curves.empty()) return {};
  nlohmann::json json;
  json["title"] = arguments.files.front();
  json["x_label"] = "$\\tau$, time between events [s]";
  json["y_label"] = "observability (0: something is unseen)";
  json["heading"] = "Observability";
  json["logarithmic"] = false;
  json["curves"] = nlohmann::json::array();
  for (const ObservabilityCurve& curve : curves) {
    json["curves"].push_back({{"label", curve.label},
                              {"x", curve.tau},
                              {"y", curve.value},
                              {"crosses", nlohmann::json::array()}});
  }
  for (const double tau : pathological_times(subject)) {
    json["lines"].push_back({{"x", tau}, {"label", "pathological intervals"}});
  }
  if (subject.T2 > 0.0 && std::isfinite(subject.T2) && subject.sensor_times.empty()) {
    json["band"] = {{"low", subject.T1}, {"high", subject.T2}, {"label", "[T1, T2]"}};
  }
  return json;
}

void draw(const nlohmann::json& chart, const ExplainArguments& arguments) {
  if (chart.is_null()) {
    throw DesignError(arguments.plot +
                      ": nothing to draw: no output is sampled or measured at jumps");
  }
  run_plot_program("plot_curves", json_text(chart), arguments.plot);
}

/// Each state along a trajectory, over time, with the jumps.
std::vector<nlohmann::json> trajectory_charts(const Plant& plant,
                                              const std::vector<TrajectoryStep>& steps) {
  nlohmann::json times = nlohmann::json::array();
  nlohmann::json jumps = nlohmann::json::array();
  std::vector<nlohmann::json> values(plant.state_names().size(), nlohmann::json::array());
  for (const TrajectoryStep& step : steps) {
    for (const bool is_end : {false, true}) {
      if (is_end && !step.jumps) continue;
      times.push_back(is_end ? step.t + step.duration : step.t);
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i].push_back((is_end ? step.end : step.begin)(static_cast<Eigen::Index>(i)));
      }
    }
    if (step.jumps) jumps.push_back({{"x", step.t + step.duration}, {"label", "jumps"}});
  }
  std::vector<nlohmann::json> charts;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = plant.state_names()[i];
    nlohmann::json curve = {
        {"label", name}, {"x", times}, {"y", values[i]}, {"crosses", nlohmann::json::array()}};
    charts.push_back({{"heading", "States along the trajectory"},
                      {"note", "As the section scenario has it, without noise."},
                      {"x_label", "time [s]"},
                      {"y_label", name},
                      {"logarithmic", false},
                      {"fills", true},
                      {"height", 210},
                      {"curves", nlohmann::json::array({curve})}});
    if (!jumps.empty()) charts.back()["lines"] = jumps;
  }
  return charts;
}

/// Prints what there is to say, and puts it on a page where one is asked for.
void tell(const std::string& text, std::vector<nlohmann::json> charts,
          const ExplainArguments& arguments) {
  std::printf("%s", text.c_str());
  if (arguments.report.empty()) return;
  DesignPage page;
  page.title = "Can " + arguments.files.front() + " be observed?";
  page.subtitle = "What `design explain` says of it.";
  page.text = text;
  page.charts = std::move(charts);
  write_page(page, arguments.report);
}

/// T of a high-gain observer in one of its two nonlinear forms.
TrajectoryCoordinates coordinates_of(const HighGainObserver& law) {
  TrajectoryCoordinates result{{},
                               inverse_powers(law.settings(), law.plant()),
                               law.saturation().scales(),
                               chains_of(law.settings(), law.plant()).first};
  if (const auto* transformed = dynamic_cast<const TransformedHighGainObserver*>(&law)) {
    for (const auto& maps : transformed->maps()) result.T.push_back(maps.T);
  } else if (const auto* original = dynamic_cast<const OriginalHighGainObserver*>(&law)) {
    result.T = original->T();
  }
  return result;
}

void explain_along(const ExplainArguments& arguments) {
  if (!arguments.plot.empty()) throw DesignError("--plot is not about --along");
  const Scenario scenario = read_scenario(arguments.files, load_plant_plugin);
  std::optional<TrajectoryCoordinates> coordinates;
  if (!arguments.gains.empty()) {
    std::vector<std::string> files = arguments.files;
    files.insert(files.end(), arguments.gains.begin(), arguments.gains.end());
    const ObserverConfig config = read_observer_config(files, load_plant_plugin);
    const auto* law = dynamic_cast<const HighGainObserver*>(&config.law->observer());
    if (law != nullptr) coordinates = coordinates_of(*law);
    if (!coordinates || coordinates->T.empty()) {
      throw DesignError(
          "--gains: expected those of a HighGainObserver in transformed or original form, whose T "
          "is looked at, found others");
    }
  }
  const std::vector<TrajectoryStep> steps = simulated_trajectory(scenario, kTrajectorySteps);
  if (steps.empty()) throw DesignError("scenario: the simulation ends at its start");
  tell(explain_trajectory(*scenario.plant, steps, coordinates ? &*coordinates : nullptr),
       trajectory_charts(*scenario.plant, steps), arguments);
}

void explain_command(const ExplainArguments& arguments) {
  std::vector<GivenFile> inputs = given_files("PLANT", arguments.files);
  for (const std::string& gains : arguments.gains) inputs.push_back({"--gains", gains});
  refuse_overwriting(inputs, {{"--plot", arguments.plot}, {"--report", arguments.report}});
  if (arguments.along) {
    explain_along(arguments);
    return;
  }
  CertificateSubject subject = read_design_config(arguments.files, load_plant_plugin).subject;
  const bool gives_times = arguments.T1 || !arguments.T2.empty();
  if (gives_times) require_common_times(subject);
  if (!arguments.T2.empty()) {
    subject.T2 = std::strtod(arguments.T2.c_str(), nullptr);
    subject.dwell_time.reset();
    if (std::isfinite(subject.T2)) {
      subject.T1 = std::min(subject.T1 > 0.0 ? subject.T1 : subject.T2, subject.T2);
    }
  }
  if (arguments.T1) subject.T1 = *arguments.T1;
  if (subject.T1 > subject.T2) throw DesignError("T1 > T2");
  if (gives_times) give_to_all_sensors(subject);
  nlohmann::json chart;
  if (!arguments.plot.empty() || !arguments.report.empty()) {
    chart = observability_chart(subject, arguments);
  }
  std::vector<nlohmann::json> charts;
  if (!chart.is_null()) charts.push_back(chart);
  tell(explain(subject), std::move(charts), arguments);
  if (!arguments.plot.empty()) draw(chart, arguments);
}

}  // namespace

void add_explain(CommandLine& tool) {
  CommandLine& command = tool.command("explain", "Why designs for a plant can or can't exist");
  auto arguments = std::make_shared<ExplainArguments>();
  command.argument("PLANT...", arguments->files, "Files with plant, sensors and design");
  command.option("--T1 SECONDS", arguments->T1, "Instead of design/sampling/T1 [s]; 0 for any")
      .check(number_at_least(0));
  command.option("--T2 SECONDS", arguments->T2, "Instead of design/sampling/T2 [s]; inf for none")
      .check(number_above_or_infinite(0));
  command
      .option("--plot FILE", arguments->plot,
              "Draw observability over the time between events (.png, .pdf, .svg)")
      .check(picture_file());
  command.option("--report FILE", arguments->report,
                 "Write what it says, with its pictures, as a page for a browser into this file");
  const Option& along =
      command.flag("--along", arguments->along,
                   "Simulate the section scenario, and tell what the linearization along the "
                   "trajectory shows: for plants given by formulas");
  command
      .option("--gains FILE...", arguments->gains,
              "With --along: files of a high-gain observer beside them, whose T is looked at")
      .needs(along);
  command.action([arguments] {
    explain_command(*arguments);
    return 0;
  });
}

}  // namespace sampled_data_observers
