#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// y += M x, column by column, for a column-major M of `rows` x `cols`; y overlaps neither.
///
/// The order of summation is fixed, which Eigen's kernels do not promise (they peel by alignment):
/// with it the same numbers give the same bits wherever they lie in memory. For the small matrices
/// of observers it is no slower.
inline void add_product(const double* __restrict M, Eigen::Index rows, Eigen::Index cols,
                        const double* __restrict x, double* __restrict y) {
  for (Eigen::Index j = 0; j < cols; ++j, M += rows) {
    const double factor = x[j];
    for (Eigen::Index i = 0; i < rows; ++i) y[i] += M[i] * factor;
  }
}

/// The same: x has M.cols() entries, y has M.rows().
inline void add_product(const Eigen::MatrixXd& M, const double* x, double* y) {
  add_product(M.data(), M.rows(), M.cols(), x, y);
}

}  // namespace sampled_data_observers
