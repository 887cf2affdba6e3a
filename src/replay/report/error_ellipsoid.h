#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

/// What a certificate says of the error e = x − x̂ of an estimate, as its Lyapunov function says it:
/// V(e) <= W, that is eᵀ Q⁻¹ e <= 1. The scale of V and W is that of det(Q)^(1/n) = W, so that W is
/// the mean squared semi-axis of the ellipsoid that holds the error, whatever the theorem.
class ErrorEllipsoid {
 public:
  /// Reads the ellipsoid of an estimate. Returns false where there is none: no bound is known.
  /// @param bound  on the norm of its error, as it is published
  bool read(const Estimate& estimate, double bound);

  /// After read(): W, in squared units of the states; 0 where that is below all numbers.
  double size() const;

  /// After read(): V(e) / W of an error of n entries.
  double share(const Eigen::VectorXd& error) const;

 private:
  Eigen::MatrixXd Q_;
  Eigen::VectorXd workspace_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace sampled_data_observers
