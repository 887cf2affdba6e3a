#include "replay/report/report_errors.h"

#include <algorithm>
#include <cmath>

namespace sampled_data_observers {
namespace {

constexpr double kSettledPart = 0.05;  // of the largest error
constexpr double kAboveSteady = 2.0;   // times the largest error of the second half

nlohmann::json or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json figures_of(const std::string& name, const ErrorFigures& errors,
                          const std::optional<double>& rmse,
                          const std::optional<double>& hold_rmse) {
  return {{"name", name},
          {"rmse", or_null(rmse)},
          {"hold_rmse", or_null(hold_rmse)},
          {"largest", or_null(errors.largest)},
          {"settling_time", or_null(errors.settling_time)},
          {"settled_within", or_null(errors.settled_within)}};
}

nlohmann::json bound_of(std::size_t stamps, std::size_t exceeded,
                        const std::optional<double>& share) {
  return {{"finite", stamps}, {"exceeded", exceeded}, {"largest_share", or_null(share)}};
}

}  // namespace

ErrorFigures error_figures(const RunRecord::Compared& compared, const std::vector<double>& errors) {
  ErrorFigures figures;
  if (errors.empty()) return figures;
  const std::vector<Stamp>& stamps = compared.stamps;
  const Stamp half = stamps.front() + (stamps.back() - stamps.front()) / 2;
  double largest = 0.0;
  double steady = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double size = std::abs(errors[i]);
    largest = std::max(largest, size);
    if (stamps[i] >= half) steady = std::max(steady, size);
    if (compared.counted[i]) figures.largest = std::max(figures.largest.value_or(0.0), size);
  }
  const double within = std::max(kSettledPart * largest, kAboveSteady * steady);
  figures.settled_within = within;
  std::size_t settled = errors.size();
  while (settled > 0 && std::abs(errors[settled - 1]) <= within) --settled;
  if (settled < errors.size()) {
    figures.settling_time = to_seconds(stamps[settled] - stamps.front());
  }
  return figures;
}

nlohmann::json error_table(const ReplaySummary& summary, const RunRecord& record) {
  nlohmann::json rows = nlohmann::json::array();
  if (summary.compared.empty()) return rows;
  for (const RunRecord::Column& column : record.columns) {
    if (!column.compared) continue;
    const std::size_t i = *column.compared;
    rows.push_back(figures_of(summary.compared[i],
                              error_figures(record.compared, record.compared.errors[i]),
                              summary.rmse[i], summary.hold_rmse[i]));
    if (summary.bounded) {
      const ReplaySummary::StateBound& bound = summary.state_bounds[i];
      rows.back()["bound"] = bound_of(bound.stamps, bound.exceeded, bound.share);
    }
  }
  rows.push_back(figures_of("norm", error_figures(record.compared, record.compared.norms),
                            summary.rmse_norm, summary.hold_rmse_norm));
  if (summary.bounded) {
    rows.back()["bound"] =
        bound_of(summary.bound_stamps, summary.bound_exceeded, summary.bound_share);
  }
  return rows;
}

}  // namespace sampled_data_observers
