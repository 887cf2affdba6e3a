#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// A norm |W x| in which the flow ẋ = A x grows no faster than e^{rate s}, with a rate close to the
/// largest real part of the eigenvalues: |W e^{As} x| <= e^{rate s} |W x| for s >= 0.
struct FlowGrowth {
  Eigen::MatrixXd W;          ///< n x n, invertible
  Eigen::MatrixXd inverse_W;  ///< n x n
  double rate = 0.0;          ///< 1/s
};

/// W is a root of ∫ e^{(A − cI)ᵀs} e^{(A − cI)s} ds, c a little above the largest real part, or the
/// identity where that does as well. Whatever W is, the rate is its own: the largest eigenvalue of
/// the symmetric part of W A W⁻¹, and a margin for rounding.
/// @param horizon  [s], > 0: the time over which e^{(c − real part) s} may count as 1
FlowGrowth flow_growth(const Eigen::MatrixXd& A, double horizon);

}  // namespace sampled_data_observers
