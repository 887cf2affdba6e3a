#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
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
  bool along = false;
  std::vector<std::string> gains;
};

void draw(const CertificateSubject& subject, const ExplainArguments& arguments) {
  const std::vector<ObservabilityCurve> curves = observability_curves(subject);
  if (curves.empty()) {
    throw DesignError(arguments.plot +
                      ": nothing to draw: no output is sampled or measured at jumps");
  }
  nlohmann::json json;
  json["title"] = arguments.files.front();
  json["x_label"] = "$\\tau$, time between events [s]";
  json["y_label"] = "observability (0: something is unseen)";
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
  run_plot_program("plot_curves", json_text(json), arguments.plot);
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
  std::printf(
      "%s",
      explain_trajectory(*scenario.plant, steps, coordinates ? &*coordinates : nullptr).c_str());
}

void explain_command(const ExplainArguments& arguments) {
  if (arguments.along) {
    explain_along(arguments);
    return;
  }
  refuse_overwriting(given_files("PLANT", arguments.files), {{"--plot", arguments.plot}});
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
  std::printf("%s", explain(subject).c_str());
  if (!arguments.plot.empty()) draw(subject, arguments);
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
