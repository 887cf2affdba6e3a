#include "linear_algebra/joseph_update.h"

#include <algorithm>

#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {

void joseph_update(const double* rows, Eigen::Index outputs, Eigen::Index size,
                   const double* innovation, double* P, const JosephWorkspace& workspace) {
  const auto [correction, gain, column, rest] = workspace;
  for (Eigen::Index i = 0; i < size; ++i) correction[i] = 0.0;
  for (Eigen::Index output = 0; output < outputs; ++output) {
    const double* c = rows + output * size;
    multiply(P, size, size, c, 1, column);
    // Rounding may leave c P cᵀ a little below zero.
    const double variance = 1.0 + std::max(0.0, dot(c, column, size));
    const double left = innovation[output] - dot(c, correction, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      gain[i] = column[i] / variance;
      correction[i] += gain[i] * left;
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      for (Eigen::Index i = 0; i < size; ++i) P[j * size + i] -= gain[i] * column[j];
    }
    multiply(P, size, size, c, 1, rest);
    for (Eigen::Index j = 0; j < size; ++j) {
      for (Eigen::Index i = j; i < size; ++i) {
        P[j * size + i] += (gain[i] - rest[i]) * gain[j];
      }
    }
    mirror_lower(P, size);
  }
}

}  // namespace sampled_data_observers
