#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

// What an interior point method asks of positive definite matrices.

constexpr double kLongStep = 1.2;

/// L of L Lᵀ = S, with zeros above the diagonal.
/// @return false where S is not positive definite
bool lower_factor(const Eigen::MatrixXd& S, Eigen::MatrixXd& L);

/// (L Lᵀ)⁻¹, symmetric to the bit.
Eigen::MatrixXd inverse_from_factor(const Eigen::MatrixXd& L);

/// The largest t for which L Lᵀ + t step is positive semidefinite, to 1 % and not more than that;
/// where it is more than kLongStep, that.
/// @param step  symmetric
double largest_step(const Eigen::MatrixXd& L, const Eigen::MatrixXd& step);

}  // namespace sampled_data_observers
