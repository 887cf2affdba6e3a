#pragma once

#include <Eigen/Core>
#include <vector>

namespace sampled_data_observers {

/// J⁻¹ r, or what stands for it where J is singular, or almost so: with Ĵ = 𝓛(ℓ)⁻¹ J S the
/// Jacobian in the units of the output and of the states' usual changes, S = diag(scales),
///
///   S (Ĵᵀ Ĵ + δ² |ĵ_1|² I)⁻¹ Ĵᵀ 𝓛(ℓ)⁻¹ r,   𝓛(ℓ) = diag(1, ℓ, …, ℓ^(n−1)),
///
/// which minimizes |Ĵ c − 𝓛⁻¹ r|² + δ² |ĵ_1|² |c|² over c (Levenberg–Marquardt). ĵ_1 is the first
/// row of Ĵ, that of the output, so that δ has no unit; |ĵ_1|² is the mean over the outputs where
/// there are several. Where all of it has no value, it is zero.
class DampedInverse {
 public:
  /// @param powers   n entries: the diagonal of 𝓛(ℓ)⁻¹
  /// @param outputs  the rows of the outputs, one or more
  /// @param scales   n entries > 0
  /// @param damping  δ >= 0; with 0 it is J⁻¹ r, and NaN where J is singular
  /// @throws std::invalid_argument for a δ that is negative or not finite.
  DampedInverse(Eigen::VectorXd powers, std::vector<Eigen::Index> outputs, Eigen::VectorXd scales,
                double damping);

  Eigen::Index workspace_size() const { return scales_.size() * (scales_.size() + 1); }

  /// r ← that of r. Allocates nothing.
  /// @param J          n x n, column-major; destroyed
  /// @param r          n entries
  /// @param workspace  workspace_size() entries
  void apply(double* J, double* r, double* workspace) const;

 private:
  Eigen::VectorXd powers_;
  std::vector<Eigen::Index> outputs_;
  Eigen::VectorXd scales_;
  double damping_;
};

}  // namespace sampled_data_observers
