#pragma once

#include <Eigen/Core>

/// Eigen's decompositions, compiled once: each takes seconds to compile, with sanitizers a minute.
namespace sampled_data_observers::test {

Eigen::MatrixXd exponential(const Eigen::MatrixXd& M);
Eigen::MatrixXd inverse(const Eigen::MatrixXd& M);

/// A basis of the kernel, in columns.
Eigen::MatrixXd kernel(const Eigen::MatrixXd& M);

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& M);

/// The λ with A v = λ B v, ascending, for a symmetric A and a positive definite B.
Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Whether Cholesky's factorization succeeds; the matrix is taken to be symmetric.
bool is_positive_definite(const Eigen::MatrixXd& M);

/// In long double. (Not overloads: an expression would fit both.)
namespace extended {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

Matrix exponential(const Matrix& M);
Matrix inverse(const Matrix& M);
Matrix kernel(const Matrix& M);

/// R with M = Rᵀ R
Matrix cholesky_upper(const Matrix& M);

}  // namespace extended
}  // namespace sampled_data_observers::test
