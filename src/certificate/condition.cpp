#include "sampled_data_observers/certificate/condition.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

#include "sampled_data_observers/certificate/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr int kRefinementBits = 20;

/// Above this ratio of the ends an equidistant grid says little of the short times.
constexpr double kWide = 8.0;

/// Equidistant values; in a wide interval as many more of equal ratio.
std::vector<double> tau_grid(double low, double high, std::size_t points) {
  if (!(low < high)) return {low};
  std::vector<double> grid;
  for (std::size_t i = 0; i + 1 < points; ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(points - 1);
    grid.push_back(low + fraction * (high - low));
    if (i > 0 && low > 0.0 && high > kWide * low) {
      grid.push_back(low * std::pow(high / low, fraction));
    }
  }
  grid.push_back(high);
  std::sort(grid.begin(), grid.end());
  return grid;
}

ConditionCheck check_over_tau(const Condition& condition, const NamedMatrices& values,
                              std::size_t points) {
  const auto least_at = [&](double tau) {
    const double least = min_eigenvalue(evaluate(condition.positive_definite, values, tau));
    return std::isfinite(least) ? least : -std::numeric_limits<double>::infinity();
  };
  const double low = condition.tau->low;
  const double high = condition.tau->high;
  const std::vector<double> grid = tau_grid(low, high, points);
  std::size_t lowest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double value = least_at(grid[i]);
    if (value < least) {
      least = value;
      lowest = i;
    }
  }
  ConditionCheck result{condition.name, least, grid[lowest]};
  if (grid.size() == 1 || !std::isfinite(least)) return result;
  const double from = grid[lowest == 0 ? 0 : lowest - 1];
  const double to = grid[std::min(lowest + 1, grid.size() - 1)];
  const auto [tau, value] =
      boost::math::tools::brent_find_minima(least_at, from, to, kRefinementBits);
  if (value < least) {
    result.min_eigenvalue = value;
    result.tau = tau;
  }
  return result;
}

}  // namespace

std::vector<ConditionCheck> check(const std::vector<Condition>& conditions,
                                  const NamedMatrices& values, std::size_t points) {
  std::vector<ConditionCheck> checks;
  for (const Condition& condition : conditions) {
    if (condition.tau) {
      checks.push_back(check_over_tau(condition, values, points));
    } else {
      checks.push_back({condition.name,
                        min_eigenvalue(evaluate(condition.positive_definite, values)),
                        std::nullopt});
    }
  }
  return checks;
}

bool all_hold(const std::vector<ConditionCheck>& checks) {
  return std::all_of(checks.begin(), checks.end(),
                     [](const ConditionCheck& check) { return check.holds(); });
}

std::string describe_violations(const std::vector<ConditionCheck>& checks) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  for (const ConditionCheck& check : checks) {
    if (check.holds()) continue;
    text << (text.tellp() > 0 ? "; " : "") << check.name << " is violated by "
         << -check.min_eigenvalue;
    if (check.tau) text << " at tau = " << *check.tau << " s";
  }
  return text.str();
}

}  // namespace sampled_data_observers
