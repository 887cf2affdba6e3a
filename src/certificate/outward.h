#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {

// Numbers that bounds rest on, rounded to the safe side.

/// Of quantities that are no differences of larger ones.
inline double raised(double value) { return value > 0.0 ? value * (1.0 + 1e-9) : value; }

/// How far an eigenvalue of a symmetric n x n matrix of this norm may be off by rounding.
inline double eigenvalue_rounding(Eigen::Index n, double norm) {
  return 1e-15 * static_cast<double>(n) * norm;
}

/// Not more than the least eigenvalue of a symmetric matrix as it is.
inline double computed_least_eigenvalue_below(const Eigen::MatrixXd& P) {
  const Eigen::VectorXd values = symmetric_eigenvalues(P);
  return values(0) - eigenvalue_rounding(P.rows(), values.cwiseAbs().maxCoeff());
}

/// Not more than the least eigenvalue of a symmetric matrix; not positive where rounding hides it,
/// also with rows and columns scaled to ones on the diagonal.
inline double least_eigenvalue_below(const Eigen::MatrixXd& P) {
  const double least = computed_least_eigenvalue_below(P);
  if (!P.allFinite() || !(P.diagonal().minCoeff() > 0.0)) return least;
  // Powers of two, which round nothing: P = D⁻¹ S D⁻¹ >= λ_min(S) D⁻².
  const Eigen::VectorXd D =
      P.diagonal().unaryExpr([](double p) { return std::exp2(-std::round(std::log2(p) / 2.0)); });
  const double scaled = computed_least_eigenvalue_below(D.asDiagonal() * P * D.asDiagonal());
  return scaled > 0.0 ? std::max(least, scaled / D.cwiseAbs2().maxCoeff()) : least;
}

/// The same for a P > 0 by which a bound on the error divides.
/// @throws std::invalid_argument where rounding hides it
inline double positive_least_eigenvalue(const Eigen::MatrixXd& P, const std::string& name) {
  const double least = least_eigenvalue_below(P);
  if (least > 0.0) return least;
  throw std::invalid_argument("the least eigenvalue of " + name +
                              " is lost in rounding: write states in units in which they are of "
                              "like size, and design again");
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
