#include "certificate/condition.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

#include "certificate/rounded_matrix.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kRefinementBits = 20;

/// Above this ratio of the ends an equidistant grid says little of the short times.
constexpr double kWide = 8.0;

/// c in c n ε ‖F‖, the rounding of an eigenvalue solver and of the scaling before it. Also allows
/// for the terms of second order that a running bound leaves out.
constexpr double kSolverRounding = 8.0;

/// Looked at between the values of a grid.
constexpr std::size_t kMaxCells = 512;

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

/// Where on the grid, or between the neighbours of the lowest point on it, a function is least.
template <class Function>
double argmin(const Function& function, const std::vector<double>& grid) {
  std::size_t lowest = 0;
  double least = function(grid.front());
  for (std::size_t i = 1; i < grid.size(); ++i) {
    const double here = function(grid[i]);
    if (!(here < least)) continue;
    least = here;
    lowest = i;
  }
  if (grid.size() == 1 || !std::isfinite(least)) return grid[lowest];
  const double from = grid[lowest == 0 ? 0 : lowest - 1];
  const double to = grid[std::min(lowest + 1, grid.size() - 1)];
  const auto [tau, value] =
      boost::math::tools::brent_find_minima(function, from, to, kRefinementBits);
  return value < least ? tau : grid[lowest];
}

ConditionCheck not_finite(const Condition& condition, std::optional<double> tau) {
  return {condition.name, condition.kind, -kUnbounded, 0.0, tau};
}

/// A matrix scaled so that the absolute values on its diagonal are 1.
struct Scaled {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd factors;
  /// By how much an eigenvalue may be wrong; not finite where nothing can be said.
  double rounding = kUnbounded;

  Eigen::MatrixXd of(const Eigen::MatrixXd& a) const {
    return factors.asDiagonal() * ((a + a.transpose()) / 2.0) * factors.asDiagonal();
  }
};

double largest_row_sum(const Eigen::MatrixXd& a) { return a.cwiseAbs().rowwise().sum().maxCoeff(); }

Scaled scaled_to_unit_diagonal(const RoundedMatrix& F) {
  Scaled scaled;
  scaled.factors = F.value.diagonal().unaryExpr(
      [](double entry) { return entry == 0.0 ? 1.0 : 1.0 / std::sqrt(std::abs(entry)); });
  scaled.matrix = scaled.of(F.value);
  if (!F.value.allFinite() || !scaled.matrix.allFinite()) return scaled;
  const auto n = static_cast<double>(F.value.rows());
  scaled.rounding = kEpsilon * (2.0 * largest_row_sum(scaled.of(F.error)) +
                                kSolverRounding * n * largest_row_sum(scaled.matrix));
  return scaled;
}

ConditionCheck check_at(const Condition& condition, const NamedMatrices& values,
                        std::optional<double> tau) {
  const RoundedMatrix F =
      evaluate_with_rounding(condition.positive_definite, values, tau.value_or(0.0));
  if (condition.is_domain()) {
    const double number = F.value(0, 0);
    if (!std::isfinite(number)) return not_finite(condition, tau);
    return {condition.name, condition.kind, number, kEpsilon * F.error(0, 0), tau};
  }
  const Scaled scaled = scaled_to_unit_diagonal(F);
  if (!std::isfinite(scaled.rounding)) return not_finite(condition, tau);
  return {condition.name, condition.kind, min_eigenvalue(scaled.matrix), scaled.rounding, tau};
}

struct Cell {
  double low = 0.0;
  double high = 0.0;
  double centre() const { return low + (high - low) / 2.0; }
};

/// Whether F(τ) is positive definite on all of a cell: F(τ_c) + h F'(τ_c) is, concave in h as its
/// least eigenvalue is, where it is at both ends, and by more than the curvature may take away. The
/// slope has its rounding where F has, but times the width; it is counted once more.
bool is_enclosed(const Condition& condition, const NamedMatrices& values, const Cell& cell) {
  const double radius = (cell.high - cell.low) / 2.0 * (1.0 + 4.0 * kEpsilon);
  const RoundedMatrix F =
      evaluate_with_rounding(condition.positive_definite, values, cell.centre(), radius);
  const Scaled scaled = scaled_to_unit_diagonal(F);
  if (!std::isfinite(scaled.rounding)) return false;
  double needed = 2.0 * scaled.rounding;
  if (F.is_constant()) return min_eigenvalue(scaled.matrix) > needed;
  const Eigen::MatrixXd change = radius * scaled.of(F.slope);
  needed += radius * radius / 2.0 * largest_row_sum(scaled.of(F.curvature));
  // Not so for NaN.
  return min_eigenvalue(scaled.matrix - change) > needed &&
         min_eigenvalue(scaled.matrix + change) > needed;
}

/// A τ between the values of a grid at which a condition does not hold, looked for where it can't
/// be enclosed; none where there is none, or none was found on kMaxCells cells.
std::optional<double> violation_between(const Condition& condition, const NamedMatrices& values,
                                        const std::vector<double>& grid) {
  std::vector<Cell> cells;
  for (std::size_t i = 1; i < grid.size(); ++i) cells.push_back({grid[i - 1], grid[i]});
  for (std::size_t next = 0; next < cells.size() && next < kMaxCells; ++next) {
    const Cell cell = cells[next];
    if (is_enclosed(condition, values, cell)) continue;
    const double centre = cell.centre();
    if (!check_at(condition, values, centre).holds()) return centre;
    if (!(cell.low < centre && centre < cell.high)) continue;
    cells.push_back({cell.low, centre});
    cells.push_back({centre, cell.high});
  }
  return std::nullopt;
}

ConditionCheck check_over_tau(const Condition& condition, const NamedMatrices& values,
                              std::size_t points) {
  const double low = condition.tau->low;
  const double high = condition.tau->high;
  if (!(low <= high)) return not_finite(condition, low);
  const std::vector<double> grid = tau_grid(low, high, points);
  const double tau =
      argmin([&](double at) { return check_at(condition, values, at).margin(); }, grid);
  ConditionCheck least = check_at(condition, values, tau);
  if (!least.holds()) return least;
  const std::optional<double> between = violation_between(condition, values, grid);
  return between ? check_at(condition, values, *between) : least;
}

Condition domain(const std::string& name, const char* relation, const MatrixExpression& value,
                 Condition::Kind kind) {
  return {name + relation, value, std::nullopt, kind};
}

}  // namespace

Condition positive(const std::string& name) {
  return domain(name, " > 0", symbol(name), Condition::Kind::kPositive);
}

Condition not_negative(const std::string& name) {
  return domain(name, " >= 0", symbol(name), Condition::Kind::kNonNegative);
}

std::vector<Condition> domain_of_times(double T1, double T2) {
  std::vector<Condition> all = {domain("T1", " >= 0", T1, Condition::Kind::kNonNegative)};
  if (T2 == kUnbounded) return all;
  all.push_back(domain("T2", " > 0", T2, Condition::Kind::kPositive));
  // The sign of a difference is never rounded.
  all.push_back(domain("T1", " <= T2", T2 - T1, Condition::Kind::kNonNegative));
  return all;
}

std::vector<ConditionCheck> check(const std::vector<Condition>& conditions,
                                  const NamedMatrices& values, std::size_t points) {
  std::vector<ConditionCheck> checks;
  for (const Condition& condition : conditions) {
    checks.push_back(condition.tau ? check_over_tau(condition, values, points)
                                   : check_at(condition, values, std::nullopt));
  }
  return checks;
}

double least_eigenvalue(const MatrixExpression& matrix, const NamedMatrices& values,
                        Condition::Range range, std::size_t points) {
  const auto at = [&](double tau) {
    const double least = min_eigenvalue(evaluate(matrix, values, tau));
    return std::isfinite(least) ? least : -kUnbounded;
  };
  return at(argmin(at, tau_grid(range.low, range.high, points)));
}

bool all_hold(const std::vector<ConditionCheck>& checks) {
  return std::all_of(checks.begin(), checks.end(),
                     [](const ConditionCheck& check) { return check.holds(); });
}

std::string describe_violations(const std::vector<ConditionCheck>& checks) {
  const ConditionCheck* worst = nullptr;
  std::size_t violated = 0;
  for (const ConditionCheck& check : checks) {
    if (check.holds()) continue;
    ++violated;
    const bool is_worse = worst == nullptr || !std::isfinite(check.min_eigenvalue) ||
                          check.min_eigenvalue < worst->min_eigenvalue;
    if (is_worse && (worst == nullptr || std::isfinite(worst->min_eigenvalue))) worst = &check;
  }
  if (worst == nullptr) return "";
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << worst->name;
  if (!std::isfinite(worst->min_eigenvalue)) {
    text << " is not finite";
  } else if (worst->min_eigenvalue > 0.0) {
    text << " holds by " << worst->min_eigenvalue
         << ", less than its check can be sure of in floating point, " << worst->rounding << ',';
  } else {
    text << " is violated by " << -worst->min_eigenvalue;
  }
  if (worst->tau) text << " at tau = " << *worst->tau << " s";
  if (violated > 1) text << ", the most of " << violated << " that do not hold";
  return text.str();
}

double least_margin(const std::vector<ConditionCheck>& checks) {
  double least = kUnbounded;
  for (const ConditionCheck& check : checks) {
    if (check.kind != Condition::Kind::kDefinite && check.holds()) continue;
    least = std::min(least, check.margin());
  }
  return least;
}

}  // namespace sampled_data_observers
