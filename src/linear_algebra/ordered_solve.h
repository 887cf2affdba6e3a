#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// b ← M⁻¹ b by Gaussian elimination with row pivoting, in a fixed order of operations. M (n x n,
/// column-major) is destroyed. Where M is singular, b becomes NaN.
void solve_in_place(double* M, double* b, Eigen::Index n);

}  // namespace sampled_data_observers
