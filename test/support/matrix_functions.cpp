#include "support/matrix_functions.h"

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace sampled_data_observers::test {
namespace extended {

Matrix exponential(const Matrix& M) { return M.exp(); }

Matrix inverse(const Matrix& M) { return M.inverse(); }

Matrix kernel(const Matrix& M) { return M.fullPivLu().kernel(); }

Matrix cholesky_upper(const Matrix& M) { return M.llt().matrixU(); }

}  // namespace extended

Eigen::MatrixXd exponential(const Eigen::MatrixXd& M) {
  return extended::exponential(M.cast<long double>()).cast<double>();
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& M) {
  return extended::inverse(M.cast<long double>()).cast<double>();
}

Eigen::MatrixXd kernel(const Eigen::MatrixXd& M) {
  return extended::kernel(M.cast<long double>()).cast<double>();
}

}  // namespace sampled_data_observers::test
