#include <algorithm>
#include <cstdio>
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
#include "design/explanation.h"
#include "messages/plant_plugins.h"
#include "tools/design/commands.h"

namespace sampled_data_observers {
namespace {

struct ExplainArguments {
  std::vector<std::string> files;
  std::optional<double> T1;  // [s]
  std::optional<double> T2;  // [s]
  std::string plot;
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
  if (subject.T2 > 0.0) {
    json["band"] = {{"low", subject.T1}, {"high", subject.T2}, {"label", "[T1, T2]"}};
  }
  run_plot_program("plot_curves", json_text(json), arguments.plot);
}

void explain_command(const ExplainArguments& arguments) {
  refuse_overwriting(given_files("PLANT", arguments.files), {{"--plot", arguments.plot}});
  CertificateSubject subject = read_design_config(arguments.files, load_plant_plugin).subject;
  if (arguments.T2) {
    subject.T2 = *arguments.T2;
    subject.T1 = std::min(subject.T1 > 0.0 ? subject.T1 : subject.T2, subject.T2);
  }
  if (arguments.T1) subject.T1 = *arguments.T1;
  if (subject.T1 > subject.T2) throw DesignError("T1 > T2");
  std::printf("%s", explain(subject).c_str());
  if (!arguments.plot.empty()) draw(subject, arguments);
}

}  // namespace

void add_explain(CommandLine& tool) {
  CommandLine& command = tool.command("explain", "Why designs for a plant can or can't exist");
  auto arguments = std::make_shared<ExplainArguments>();
  command.argument("PLANT...", arguments->files, "Files with plant, sensors and design");
  command.option("--T1 SECONDS", arguments->T1, "Instead of design/sampling/T1 [s]")
      .check(number_above(0));
  command.option("--T2 SECONDS", arguments->T2, "Instead of design/sampling/T2 [s]")
      .check(number_above(0));
  command
      .option("--plot FILE", arguments->plot,
              "Draw observability over the time between events (.png, .pdf, .svg)")
      .check(picture_file());
  command.action([arguments] {
    explain_command(*arguments);
    return 0;
  });
}

}  // namespace sampled_data_observers
