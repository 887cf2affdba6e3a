#include "replay/report/report_errors.h"

#include <algorithm>
#include <cmath>

namespace sampled_data_observers {
namespace {

constexpr double kSettledPart = 0.05;  // of the largest error
constexpr double kAboveSteady = 2.0;   // times the largest error of the second half

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

}  // namespace sampled_data_observers
