#pragma once

#include <Eigen/Core>

#include "certificate/matrix_expression.h"
#include "certificate/numeric_algebra.h"

namespace sampled_data_observers {

/// A matrix F(τ) computed in floating point at τ_c, with a running bound on its rounding and one on
/// how it goes on from there.
///
/// Entry by entry, the exact value differs by at most error times ε = 2⁻⁵², to first order. The
/// exact value is that for any numbers of which those given are the nearest doubles; whole numbers
/// are exact. Cancellation is so accounted for: the difference of two numbers of 1e9 has an error
/// of 1e9 ε or more, however small it is.
///
/// For |h| <= r, F(τ_c + h) = F(τ_c) + h slope + (h²/2) X with |X| <= curvature, entry by entry.
struct RoundedMatrix {
  Eigen::MatrixXd value;
  /// In units of ε; not finite where nothing can be said.
  Eigen::MatrixXd error;
  /// Both have no entries where F does not depend on τ, or r is 0. The curvature is not finite
  /// where nothing can be said.
  Eigen::MatrixXd slope = {};
  Eigen::MatrixXd curvature = {};

  bool is_constant() const { return slope.size() == 0; }
};

/// The value of an expression with its rounding, and with its slope where the radius is not 0.
/// @param radius  r >= 0 [s]
/// @throws as evaluate()
RoundedMatrix evaluate_with_rounding(const MatrixExpression& expression,
                                     const NamedMatrices& values, double tau = 0.0,
                                     double radius = 0.0);

}  // namespace sampled_data_observers
