#pragma once

#include <Eigen/Core>
#include <string>

#include "certificate/form_maximum.h"
#include "certificate/matrix_expression.h"
#include "certificate/numeric_algebra.h"

namespace sampled_data_observers {

/// An upper bound on P⁻¹ in the order of symmetric matrices: P⁻¹ <= X = Xᵀ, so that eᵀ P e <= W
/// gives e eᵀ <= W X and e_j² <= W X_jj. From the residual of a computed inverse, with a bound on
/// its own rounding; I/λ where that shows nothing.
/// @param P      n x n, > 0
/// @param least  λ > 0, not more than the least eigenvalue of P
Eigen::MatrixXd inverse_above(const Eigen::MatrixXd& P, double least);

/// The same, whatever rounding has done to the value of P, named so for messages.
/// @throws std::invalid_argument where rounding hides its least eigenvalue
Eigen::MatrixXd inverse_above(const MatrixExpression& P, const NamedMatrices& values,
                              const std::string& name);

/// The errors e with eᵀ P e <= r², P > 0, in which a quadratic Lyapunov function keeps the error.
/// Allocates nothing once it is built.
class SublevelSet {
 public:
  SublevelSet() = default;
  /// @param least  as for inverse_above()
  SublevelSet(const Eigen::MatrixXd& P, double least);

  /// |e_j| at most, for each j: r √(P⁻¹)_jj.
  void bounds(double r, Eigen::Ref<Eigen::VectorXd> bounds) const { bounds = r * widths_; }

  /// r of the one that holds all e with e eᵀ <= Q.
  double radius_around(const Eigen::Ref<const Eigen::MatrixXd>& Q) const;

  /// Q with e eᵀ <= Q: r² P⁻¹.
  void ellipsoid(double r, Eigen::Ref<Eigen::MatrixXd> Q) const { Q = (r * r) * inverse_; }

 private:
  FormMaximum form_;
  Eigen::MatrixXd inverse_;
  Eigen::VectorXd widths_;
};

}  // namespace sampled_data_observers
