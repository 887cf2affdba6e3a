#include "observer/saturation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sampled_data_observers {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Saturation::Saturation(Eigen::Index n)
    : low_(Eigen::VectorXd::Constant(n, -kInfinity)),
      high_(Eigen::VectorXd::Constant(n, kInfinity)),
      scales_(Eigen::VectorXd::Ones(n)) {}

void Saturation::bound(Eigen::Index state, double low, double high) {
  if (state < 0 || state >= size()) throw std::invalid_argument("Saturation: no such state");
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high)) {
    throw std::invalid_argument("Saturation: low < high must hold, both finite");
  }
  low_(state) = low;
  high_(state) = high;
  scales_(state) = 0.5 * (high - low);
}

std::optional<Eigen::RowVector2d> Saturation::bounds(Eigen::Index state) const {
  if (low_(state) == -kInfinity) return std::nullopt;
  return Eigen::RowVector2d(low_(state), high_(state));
}

void Saturation::apply(double* x) const {
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (low_(i) == -kInfinity) continue;
    // std::max gives its first argument where the second is NaN.
    x[i] = std::min(std::max(low_(i), x[i]), high_(i));
  }
}

bool Saturation::is_active(const double* x) const {
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (!(low_(i) < x[i] && x[i] < high_(i))) return true;
  }
  return false;
}

}  // namespace sampled_data_observers
