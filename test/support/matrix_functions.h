#pragma once

#include <Eigen/Core>

/// Eigen's decompositions in long double, compiled once: each takes seconds to compile, with
/// sanitizers a minute.
namespace sampled_data_observers::test {

Eigen::MatrixXd exponential(const Eigen::MatrixXd& M);
Eigen::MatrixXd inverse(const Eigen::MatrixXd& M);

/// A basis of the kernel, in columns.
Eigen::MatrixXd kernel(const Eigen::MatrixXd& M);

/// (Not overloads: an expression would fit both.)
namespace extended {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

Matrix exponential(const Matrix& M);
Matrix inverse(const Matrix& M);
Matrix kernel(const Matrix& M);

/// R with M = Rᵀ R
Matrix cholesky_upper(const Matrix& M);

}  // namespace extended
}  // namespace sampled_data_observers::test
