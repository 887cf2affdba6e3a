#include "linear_algebra/ordered_solve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sampled_data_observers {

void solve_in_place(double* M, double* b, Eigen::Index n) {
  const auto at = [M, n](Eigen::Index row, Eigen::Index col) -> double& {
    return M[col * n + row];
  };
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::abs(at(i, k)) > std::abs(at(pivot, k))) pivot = i;
    }
    if (!(std::abs(at(pivot, k)) > 0.0)) {
      std::fill_n(b, n, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    if (pivot != k) {
      for (Eigen::Index j = k; j < n; ++j) std::swap(at(k, j), at(pivot, j));
      std::swap(b[k], b[pivot]);
    }
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const double factor = at(i, k) / at(k, k);
      for (Eigen::Index j = k + 1; j < n; ++j) at(i, j) -= factor * at(k, j);
      b[i] -= factor * b[k];
    }
  }
  for (Eigen::Index i = n - 1; i >= 0; --i) {
    for (Eigen::Index j = i + 1; j < n; ++j) b[i] -= at(i, j) * b[j];
    b[i] /= at(i, i);
  }
}

}  // namespace sampled_data_observers
