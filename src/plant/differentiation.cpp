#include "plant/differentiation.h"

#include <algorithm>
#include <cmath>

namespace sampled_data_observers {
namespace {

/// The step relative to the variable: the third root of the rounding unit, a power of two.
constexpr double kRelativeStep = 1.0 / 131072.0;

}  // namespace

void differentiate(const VectorMap& map, const double* x, const double* u,
                   const Eigen::VectorXd& scales, double* J, double* workspace) {
  const Eigen::Index n = scales.size();
  const Eigen::Index rows = map.size();
  double* point = workspace;
  double* above = point + n;
  double* below = above + rows;
  std::copy_n(x, n, point);
  for (Eigen::Index j = 0; j < n; ++j, J += rows) {
    const double step = kRelativeStep * std::max(std::abs(x[j]), scales(j));
    point[j] = x[j] + step;
    const double high = point[j];
    map.evaluate(point, u, above);
    point[j] = x[j] - step;
    // What was rounded off the step must not count.
    const double width = high - point[j];
    map.evaluate(point, u, below);
    point[j] = x[j];
    for (Eigen::Index i = 0; i < rows; ++i) J[i] = (above[i] - below[i]) / width;
  }
}

}  // namespace sampled_data_observers
