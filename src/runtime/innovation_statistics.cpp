#include <algorithm>
#include <cmath>
#include <limits>

#include "sampled_data_observers/runtime/run_statistics.h"

namespace sampled_data_observers {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

void add_entries(const std::vector<double>& from, std::vector<double>& to) {
  if (to.size() < from.size()) to.resize(from.size(), 0.0);
  for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
}

}  // namespace

void InnovationStatistics::add(const double* innovation, Eigen::Index size, double nis) {
  const auto outputs = static_cast<std::size_t>(size);
  if (sums.size() < outputs) {
    sums.resize(outputs, 0.0);
    squares.resize(outputs, 0.0);
  }
  ++count;
  for (std::size_t i = 0; i < outputs; ++i) {
    sums[i] += innovation[i];
    squares[i] += innovation[i] * innovation[i];
  }
  if (std::isnan(nis)) return;
  ++nis_count;
  nis_sum += nis;
}

void InnovationStatistics::add(const InnovationStatistics& other) {
  count += other.count;
  add_entries(other.sums, sums);
  add_entries(other.squares, squares);
  nis_count += other.nis_count;
  nis_sum += other.nis_sum;
}

void InnovationStatistics::clear() {
  count = nis_count = 0;
  nis_sum = 0.0;
  std::fill(sums.begin(), sums.end(), 0.0);
  std::fill(squares.begin(), squares.end(), 0.0);
}

double InnovationStatistics::mean(std::size_t output) const {
  return count == 0 ? kNothing : sums[output] / static_cast<double>(count);
}

double InnovationStatistics::rms(std::size_t output) const {
  return count == 0 ? kNothing : std::sqrt(squares[output] / static_cast<double>(count));
}

double InnovationStatistics::nis() const {
  return nis_count == 0 ? kNothing : nis_sum / static_cast<double>(nis_count);
}

}  // namespace sampled_data_observers
