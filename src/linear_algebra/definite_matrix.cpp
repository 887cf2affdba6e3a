#include "linear_algebra/definite_matrix.h"

#include <cmath>
#include <stdexcept>

#include "linear_algebra/matrix_functions.h"
#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {
namespace {

constexpr double kRounding = 1e-12;

void require(bool holds, const std::string& name, const std::string& what) {
  if (!holds) throw std::invalid_argument(name + " must be " + what);
}

Eigen::MatrixXd checked_symmetric(const std::string& name, const Eigen::MatrixXd& matrix,
                                  Eigen::Index n) {
  const std::string size = std::to_string(n);
  require(matrix.rows() == n && matrix.cols() == n, name, size + " x " + size);
  require(matrix.allFinite(), name, "finite");
  const double largest = matrix.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      require(std::abs(matrix(i, j) - matrix(j, i)) <= kRounding * largest, name,
              "symmetric; entries (" + std::to_string(i + 1) + ", " + std::to_string(j + 1) +
                  ") and (" + std::to_string(j + 1) + ", " + std::to_string(i + 1) + ") differ");
    }
  }
  return (matrix + matrix.transpose()) / 2.0;
}

}  // namespace

Eigen::MatrixXd checked_positive_definite(const std::string& name, const Eigen::MatrixXd& matrix,
                                          Eigen::Index n) {
  Eigen::MatrixXd symmetric = checked_symmetric(name, matrix, n);
  Eigen::MatrixXd factor = symmetric;
  require(factor_cholesky(factor.data(), n), name, "positive definite");
  return symmetric;
}

Eigen::MatrixXd checked_positive_semidefinite(const std::string& name,
                                              const Eigen::MatrixXd& matrix, Eigen::Index n) {
  Eigen::MatrixXd symmetric = checked_symmetric(name, matrix, n);
  const std::string what = "positive semidefinite";
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    require(symmetric(i, i) >= 0.0, name, what);
    require(symmetric(i, i) > 0.0 || symmetric.col(i).isZero(0.0), name, what);
    scale(i) = symmetric(i, i) > 0.0 ? 1.0 / std::sqrt(symmetric(i, i)) : 1.0;
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * symmetric * scale.asDiagonal();
  require(min_eigenvalue(scaled) >= -kRounding * static_cast<double>(n), name, what);
  return symmetric;
}

}  // namespace sampled_data_observers
