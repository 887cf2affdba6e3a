#pragma once

#include <Eigen/Core>
#include <cmath>

#include "sampled_data_observers/linear_algebra/ordered_product.h"

// Small dense linear algebra in a fixed order of summation, as in add_product(): the same numbers
// give the same bits wherever they lie in memory. All matrices are column-major. Nothing is
// allocated; results overlap no argument.

namespace sampled_data_observers {

/// Below this share of its original size, what a factorization leaves of a column is rounding.
constexpr double kRankTolerance = 1e-14;

/// C ← A B with A of rows x inner, B of inner x cols.
inline void multiply(const double* A, Eigen::Index rows, Eigen::Index inner, const double* B,
                     Eigen::Index cols, double* C) {
  for (Eigen::Index j = 0; j < cols; ++j, B += inner, C += rows) {
    for (Eigen::Index i = 0; i < rows; ++i) C[i] = 0.0;
    add_product(A, rows, inner, B, C);
  }
}

/// C ← A Bᵀ with A of rows x inner, B of cols x inner.
inline void multiply_by_transposed(const double* A, Eigen::Index rows, Eigen::Index inner,
                                   const double* B, Eigen::Index cols, double* C) {
  for (Eigen::Index j = 0; j < cols; ++j, C += rows) {
    for (Eigen::Index i = 0; i < rows; ++i) C[i] = 0.0;
    for (Eigen::Index k = 0; k < inner; ++k) {
      const double factor = B[k * cols + j];
      for (Eigen::Index i = 0; i < rows; ++i) C[i] += A[k * rows + i] * factor;
    }
  }
}

/// a · b of two vectors.
inline double dot(const double* a, const double* b, Eigen::Index size) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

/// Copies the lower triangle of a square matrix onto the upper one.
inline void mirror_lower(double* M, Eigen::Index n) {
  for (Eigen::Index j = 1; j < n; ++j) {
    for (Eigen::Index i = 0; i < j; ++i) M[j * n + i] = M[i * n + j];
  }
}

/// C ← C + A Bᵀ where the sum is known to be symmetric: it is computed for the lower triangle and
/// mirrored, so that C is symmetric to the bit. A and B are n x inner, C n x n.
inline void add_symmetric_product(const double* A, const double* B, Eigen::Index n,
                                  Eigen::Index inner, double* C) {
  for (Eigen::Index k = 0; k < inner; ++k, A += n, B += n) {
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = j; i < n; ++i) C[j * n + i] += A[i] * B[j];
    }
  }
  mirror_lower(C, n);
}

/// M ← the symmetric matrix whose lower triangle stands in `rows`, row by row.
inline void unpack_lower(const double* rows, Eigen::Index n, double* M) {
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) M[i + j * n] = M[j + i * n] = *rows++;
  }
}

/// M ← L, lower triangular, with M = L Lᵀ; only the lower triangle of M is read, the upper one
/// becomes zero. Returns false, and leaves M of no use, where a pivot is not greater than
/// `tolerance` times the diagonal entry it came from: M is not positive definite, or not finite.
inline bool factor_cholesky(double* M, Eigen::Index n, double tolerance = kRankTolerance) {
  for (Eigen::Index j = 0; j < n; ++j) {
    double* column = M + j * n;
    const double diagonal = column[j];
    for (Eigen::Index k = 0; k < j; ++k) {
      const double factor = M[k * n + j];
      for (Eigen::Index i = j; i < n; ++i) column[i] -= M[k * n + i] * factor;
    }
    if (!(column[j] > tolerance * diagonal) || !(column[j] > 0.0)) return false;
    const double root = std::sqrt(column[j]);
    for (Eigen::Index i = 0; i < j; ++i) column[i] = 0.0;
    column[j] = root;
    for (Eigen::Index i = j + 1; i < n; ++i) column[i] /= root;
  }
  return true;
}

/// M ← L, lower triangular, with M = L Lᵀ for a positive semidefinite M, of which only the lower
/// triangle is read. Where what is left of a diagonal entry is not greater than kRankTolerance
/// times the entry, or than zero, it is rounding, and that column of L is zero. What is not a
/// number makes columns of L that are none.
inline void factor_semidefinite(double* M, Eigen::Index n) {
  for (Eigen::Index j = 0; j < n; ++j) {
    double* column = M + j * n;
    const double diagonal = column[j];
    for (Eigen::Index k = 0; k < j; ++k) {
      const double factor = M[k * n + j];
      if (factor == 0.0) continue;
      for (Eigen::Index i = j; i < n; ++i) column[i] -= M[k * n + i] * factor;
    }
    const bool is_rounding = column[j] <= kRankTolerance * diagonal || column[j] <= 0.0;
    const double root = std::sqrt(column[j]);
    for (Eigen::Index i = 0; i < j; ++i) column[i] = 0.0;
    for (Eigen::Index i = j; i < n; ++i) column[i] = is_rounding ? 0.0 : column[i] / root;
  }
}

/// L ← the lower triangular factor of MᵀM = L Lᵀ (cols x cols), without forming the product: by the
/// modified Gram–Schmidt process, which overwrites M (rows x cols) with orthonormal columns.
/// Returns false where a column depends on those before it, or is not finite.
inline bool factor_gram(double* M, Eigen::Index rows, Eigen::Index cols, double* L) {
  for (Eigen::Index i = 0; i < cols * cols; ++i) L[i] = 0.0;
  for (Eigen::Index j = 0; j < cols; ++j) {
    double* column = M + j * rows;
    const double original = std::sqrt(dot(column, column, rows));
    for (Eigen::Index k = 0; k < j; ++k) {
      const double* unit = M + k * rows;
      const double share = dot(unit, column, rows);
      L[k * cols + j] = share;
      for (Eigen::Index i = 0; i < rows; ++i) column[i] -= share * unit[i];
    }
    const double norm = std::sqrt(dot(column, column, rows));
    if (!(norm > kRankTolerance * original)) return false;
    L[j * cols + j] = norm;
    for (Eigen::Index i = 0; i < rows; ++i) column[i] /= norm;
  }
  return true;
}

/// B ← L⁻¹ B. L is the leading n x n block, lower triangular, of a matrix of `stride` rows; B is
/// n x cols.
inline void solve_lower(const double* L, Eigen::Index stride, Eigen::Index n, double* B,
                        Eigen::Index cols) {
  for (Eigen::Index c = 0; c < cols; ++c, B += n) {
    for (Eigen::Index j = 0; j < n; ++j) {
      B[j] /= L[j * stride + j];
      for (Eigen::Index i = j + 1; i < n; ++i) B[i] -= L[j * stride + i] * B[j];
    }
  }
}

/// B ← L⁻ᵀ B, with L and B as for solve_lower().
inline void solve_lower_transposed(const double* L, Eigen::Index stride, Eigen::Index n, double* B,
                                   Eigen::Index cols) {
  for (Eigen::Index c = 0; c < cols; ++c, B += n) {
    for (Eigen::Index j = n - 1; j >= 0; --j) {
      for (Eigen::Index i = j + 1; i < n; ++i) B[j] -= L[j * stride + i] * B[i];
      B[j] /= L[j * stride + j];
    }
  }
}

}  // namespace sampled_data_observers
