#include "observer/unit_norm_covariance.h"

#include <cmath>

#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {

void project_covariance(const Plant& plant, const double* x, double* P) {
  const Eigen::Index n = plant.states();
  for (const std::vector<Eigen::Index>& group : plant.unit_norms()) {
    double squares = 0.0;
    for (const Eigen::Index i : group) squares += x[i] * x[i];
    if (squares == 0.0) continue;
    const double norm = std::sqrt(squares);
    // To a row or a column of P, whose entries are `stride` apart.
    const auto apply = [&](double* line, Eigen::Index stride) {
      double along = 0.0;
      for (const Eigen::Index i : group) along += x[i] * line[i * stride];
      for (const Eigen::Index i : group) {
        line[i * stride] = (line[i * stride] - x[i] * along / squares) / norm;
      }
    };
    for (Eigen::Index j = 0; j < n; ++j) apply(P + j * n, 1);
    for (Eigen::Index i = 0; i < n; ++i) apply(P + i, n);
    mirror_lower(P, n);
  }
}

}  // namespace sampled_data_observers
