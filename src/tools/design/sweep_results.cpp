#include "tools/design/sweep_results.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "console/json_text.h"
#include "console/plot_program.h"
#include "design/paragraphs.h"
#include "design/sweep_folder.h"
#include "files/csv.h"
#include "tools/design/design_page.h"

namespace sampled_data_observers {
namespace {

/// From this ratio of values on, they are drawn on a logarithmic axis.
constexpr double kLogarithmicFrom = 8.0;

/// Formats of the curves.
constexpr std::array<const char*, 2> kPictures = {"png", "svg"};

constexpr char kPage[] = "report.html";

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
                        const std::vector<SweepPoint>& points, const std::string& plant_file) {
  nlohmann::json json;
  json["title"] = plant_file;
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

}  // namespace

std::vector<std::string> names_of_pictures() {
  std::vector<std::string> names;
  for (const char* ending : kPictures) names.push_back(std::string("curve.") + ending);
  names.emplace_back(kPage);
  return names;
}

void draw_sweep(const SweepRequest& request, const std::vector<CurvePoint>& curves,
                const std::vector<SweepPoint>& points, const std::string& plant_file,
                const std::string& folder) {
  nlohmann::json json = chart_of(request, curves, points, plant_file);
  for (const char* ending : kPictures) {
    run_plot_program("plot_curves", json_text(json), folder + "/curve." + ending);
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
  write_page(page, folder + "/" + kPage);
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

}  // namespace sampled_data_observers
