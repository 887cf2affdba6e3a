#include "replay/plot.h"

#include <nlohmann/json.hpp>

#include "console/json_text.h"
#include "console/plot_program.h"

namespace sampled_data_observers {
namespace {

nlohmann::json to_json(const Series& series) {
  return {{"times", series.times}, {"values", series.values}};
}

}  // namespace

void draw_plot(const ReplaySummary& summary, const std::string& path) {
  nlohmann::json json;
  json["title"] = summary.observer + " on " + summary.bag.substr(summary.bag.rfind('/') + 1) +
                  ": " + std::to_string(summary.samples_used) + " samples used";
  json["sample_times"] = summary.sample_times;
  json["jump_times"] = summary.jump_times;
  for (const QuantityPlot& plot : summary.plots) {
    json["quantities"].push_back({{"name", plot.name},
                                  {"truth", to_json(plot.truth)},
                                  {"samples", to_json(plot.samples)},
                                  {"estimate", to_json(plot.estimate)},
                                  {"bound", to_json(plot.bound)}});
  }
  run_plot_program("plot_replay", json_text(json), path);
}

}  // namespace sampled_data_observers
