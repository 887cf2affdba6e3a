#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {

// The unscented transformation (S. J. Julier, J. K. Uhlmann, Unscented filtering and nonlinear
// estimation, Proceedings of the IEEE 92(3), 2004) of x ~ (x̂, P), P = Λ Λᵀ with columns λ_i, by a
// map T: with n + κ = 3, its points are x̂ and x̂ ± √3 λ_i. Of δ_i± = T(x̂ ± √3 λ_i) − T(x̂),
//
//   o_i = (δ_i+ − δ_i−) / (2 √3),  e_i = (δ_i+ + δ_i−) / √18
//   mean T(x̂) + Σ e_i / √2,  cov(T(x), x) = Σ o_i λ_iᵀ,  cov T(x) = Σ o_i o_iᵀ + e_i e_iᵀ
//
// Mean and cross covariance are the unscented ones. The covariance is that of M. Nørgaard, N. K.
// Poulsen, O. Ravn, New developments in state estimation for nonlinear systems, Automatica 36(11),
// 2000, which is positive semidefinite for any n; with the weights of the points, which are
// negative for n > 3, it need not be. For x of normal distribution it is exact where T is the sum
// of a linear map and of squares of independent variables.

constexpr double kSqrt3 = 1.7320508075688772;
constexpr double kSqrt2 = 1.4142135623730951;

/// spread ← (o_1 … o_size, e_1 … e_size), rows x 2 size.
/// @param factor      Λ, size x size
/// @param difference  difference(point, out) sets `out` to T(point) − T(x̂), `rows` entries, and may
///                    write on the point
/// @param point       scratch of `size` entries
template <class Difference>
void spread_of_points(const double* x, const double* factor, Eigen::Index size, Eigen::Index rows,
                      double* point, double* spread, const Difference& difference) {
  for (Eigen::Index i = 0; i < size; ++i) {
    const double* column = factor + i * size;
    double* odd = spread + i * rows;
    double* even = spread + (size + i) * rows;
    if (std::all_of(column, column + size, [](double entry) { return entry == 0.0; })) {
      std::fill_n(odd, rows, 0.0);
      std::fill_n(even, rows, 0.0);
      continue;
    }
    for (Eigen::Index j = 0; j < size; ++j) point[j] = x[j] + kSqrt3 * column[j];
    difference(point, odd);
    for (Eigen::Index j = 0; j < size; ++j) point[j] = x[j] - kSqrt3 * column[j];
    difference(point, even);
    for (Eigen::Index row = 0; row < rows; ++row) {
      const double above = odd[row];
      const double below = even[row];
      odd[row] = (above - below) / (2.0 * kSqrt3);
      even[row] = (above + below) / (3.0 * kSqrt2);
    }
  }
}

/// What the mean of T(x) is beyond T(x̂), added to `mean`.
inline void add_shift_of_mean(const double* spread, Eigen::Index size, Eigen::Index rows,
                              double* mean) {
  for (Eigen::Index i = size; i < 2 * size; ++i) {
    for (Eigen::Index row = 0; row < rows; ++row) mean[row] += spread[i * rows + row] / kSqrt2;
  }
}

/// P ← P + cov T(x); P is rows x rows, symmetric to the bit, and so again.
inline void add_covariance_of_spread(const double* spread, Eigen::Index size, Eigen::Index rows,
                                     double* P) {
  add_symmetric_product(spread, spread, rows, 2 * size, P);
}

}  // namespace sampled_data_observers
