#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "linear_algebra/matrix_functions.h"
#include "sampled_data_observers/observer/observer_law.h"

namespace sampled_data_observers::test {

/// How much of what a law guarantees in a state its error takes, entry by entry.
class StateShares {
 public:
  explicit StateShares(const ObserverLaw& law)
      : law_(law),
        workspace_(law.workspace_size()),
        bounds_(law.estimate_size()),
        Q_(law.estimate_size(), law.estimate_size()) {}

  const Eigen::VectorXd& bounds(const Eigen::VectorXd& state) {
    law_.state_bounds(state.data(), workspace_.data(), bounds_);
    return bounds_;
  }

  /// The largest |e_j| over its bound. @param rounding  of the error, less than which is nothing
  double largest(const Eigen::VectorXd& state, const Eigen::VectorXd& error, double rounding) {
    bounds(state);
    double share = 0.0;
    for (Eigen::Index j = 0; j < error.size(); ++j) {
      const double size = std::max(0.0, std::abs(error(j)) - rounding);
      share = std::max(share, size / std::max(bounds_(j), 1e-300));
    }
    return share;
  }

  /// √(eᵀ Q⁻¹ e) of the ellipsoid; 0 where rounding is all there is of it.
  double of_ellipsoid(const Eigen::VectorXd& state, const Eigen::VectorXd& error, double rounding) {
    law_.error_ellipsoid(state.data(), workspace_.data(), Q_);
    if (!(Q_.diagonal().minCoeff() > 1e8 * rounding * rounding)) return 0.0;
    const Eigen::VectorXd d = Q_.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::VectorXd scaled = d.cwiseProduct(error);
    const double square = scaled.dot(inverse_of(d.asDiagonal() * Q_ * d.asDiagonal()) * scaled);
    return std::sqrt(std::max(0.0, square));
  }

 private:
  const ObserverLaw& law_;
  Eigen::VectorXd workspace_;
  Eigen::VectorXd bounds_;
  Eigen::MatrixXd Q_;
};

}  // namespace sampled_data_observers::test
