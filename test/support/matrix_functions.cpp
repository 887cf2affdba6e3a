#include "support/matrix_functions.h"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace sampled_data_observers::test {

Eigen::MatrixXd exponential(const Eigen::MatrixXd& M) { return M.exp(); }

Eigen::MatrixXd inverse(const Eigen::MatrixXd& M) { return M.inverse(); }

Eigen::MatrixXd kernel(const Eigen::MatrixXd& M) { return M.fullPivLu().kernel(); }

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& M) { return M.eigenvalues(); }

Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(A, B).eigenvalues();
}

bool is_positive_definite(const Eigen::MatrixXd& M) { return M.llt().info() == Eigen::Success; }

namespace extended {

Matrix exponential(const Matrix& M) { return M.exp(); }

Matrix inverse(const Matrix& M) { return M.inverse(); }

Matrix kernel(const Matrix& M) { return M.fullPivLu().kernel(); }

Matrix cholesky_upper(const Matrix& M) { return M.llt().matrixU(); }

}  // namespace extended
}  // namespace sampled_data_observers::test
