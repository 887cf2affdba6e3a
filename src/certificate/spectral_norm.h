#pragma once

#include <Eigen/Core>

namespace sampled_data_observers {

/// Number of entries that spectral_norm_bound() needs in `workspace`.
constexpr Eigen::Index spectral_norm_workspace(Eigen::Index cols) { return 2 * cols * cols; }

/// An upper bound on ‖M‖₂, M of rows x cols, column-major, that allocates nothing: from
/// λ^p <= ‖G^p‖_F <= √n λ^p for the largest eigenvalue λ of G = MᵀM, with p = 1024. It is at most
/// the factor n^{1/4096} too large, and covers its own rounding. Infinite where M is not finite.
double spectral_norm_bound(const double* M, Eigen::Index rows, Eigen::Index cols,
                           double* workspace);

}  // namespace sampled_data_observers
