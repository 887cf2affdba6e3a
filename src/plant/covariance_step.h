#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// Number of entries that covariance_step() needs as workspace.
Eigen::Index covariance_step_workspace(Eigen::Index n);

/// One step of the covariance of a flow that is integrated, Ṗ = F P + P Fᵀ + Q:
///
///   P ← Φ (P + h/2 Q) Φᵀ + h/2 Q,  Φ = I + h F + … + (h F)⁴/24
///
/// with F at the middle of the step: of second order in h. For a constant F, Φ is that of the
/// Runge–Kutta step of the state. P stays positive semidefinite to rounding, for any h, and is
/// symmetric to the bit. What is zero in F and Φ costs nothing.
/// @param F  n x n, per second
/// @param Q  n x n, per second, symmetric to the bit
/// @param h  of the step, seconds
/// @param P  n x n, symmetric to the bit
void covariance_step(const double* F, const double* Q, Eigen::Index n, double h, double* P,
                     double* workspace);

}  // namespace sampled_data_observers
