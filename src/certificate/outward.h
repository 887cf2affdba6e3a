#pragma once

#include <Eigen/Core>

#include "sampled_data_observers/certificate/matrix_functions.h"

namespace sampled_data_observers {

// Numbers that bounds rest on, rounded to the safe side.

/// Of quantities that are no differences of larger ones.
inline double raised(double value) { return value > 0.0 ? value * (1.0 + 1e-9) : value; }

/// How far an eigenvalue of a symmetric n x n matrix of this norm may be off by rounding.
inline double eigenvalue_rounding(Eigen::Index n, double norm) {
  return 1e-15 * static_cast<double>(n) * norm;
}

/// Not more than the least eigenvalue of a symmetric matrix; not positive where rounding hides it.
inline double least_eigenvalue_below(const Eigen::MatrixXd& P) {
  const Eigen::VectorXd values = symmetric_eigenvalues(P);
  return values(0) - eigenvalue_rounding(P.rows(), values.cwiseAbs().maxCoeff());
}

/// Not less than the largest eigenvalue of a symmetric matrix >= 0.
inline double largest_eigenvalue_above(const Eigen::MatrixXd& P) {
  return raised(max_eigenvalue(P));
}

/// Not less than the rate c at which V = xᵀ P x grows along ẋ = A x at most: V̇ <= 2 c V.
inline double growth_above(const Eigen::MatrixXd& P, const Eigen::MatrixXd& A) {
  const Eigen::MatrixXd R = cholesky_root(P);
  const Eigen::MatrixXd inverse_R = inverse_of(R);
  const double size = (R.cwiseAbs() * A.cwiseAbs() * inverse_R.cwiseAbs()).norm();
  return max_eigenvalue(R * A * inverse_R) + 1e3 * eigenvalue_rounding(P.rows(), size);
}

}  // namespace sampled_data_observers
