#pragma once

#include <Eigen/Core>

#include "sampled_data_observers/hybrid/state_layout.h"
#include "sampled_data_observers/plant/linear_flow.h"

namespace sampled_data_observers {

/// The gain L(τ), n x m, with which a jump τ after the one before is corrected, from a metric P:
/// with Ψ⁻¹ = e^{Aτ} P⁻¹ e^{Aᵀτ},
///
///   L(τ) = A_d Ψ⁻¹ Hᵀ (H Ψ⁻¹ Hᵀ)⁻¹
///
/// (x − x̂)ᵀ Ψ (x − x̂) is just before the jump what (x − x̂)ᵀ P (x − x̂) was just after the one
/// before. x̂ is moved the least in this norm so that it has the measured output, and then jumps as
/// the plant does. That is the elimination of the gain in sferlazza2019, (25), with a jump map: no
/// other gain makes more of the worst error.
///
/// Immutable; evaluate() allocates nothing and throws nothing.
class MetricGain {
 public:
  /// @param A    n x n
  /// @param A_d  n x n
  /// @param H    m x n
  /// @param P    n x n, symmetric positive definite
  /// @throws std::invalid_argument where the rows of H are not linearly independent.
  MetricGain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& A_d, const Eigen::MatrixXd& H,
             const Eigen::MatrixXd& P);

  /// Number of entries that evaluate() needs in `workspace`.
  Eigen::Index workspace_size() const { return workspace_.size(); }

  /// L ← L(τ), column-major, for τ >= 0; L(0) after so long a time that e^{Aτ} overflows, or shows
  /// the outputs as dependent.
  void evaluate(Duration tau, double* L, double* workspace) const;

 private:
  bool evaluate_where_regular(Duration tau, double* L, double* workspace) const;

  Eigen::Index n_;
  Eigen::Index m_;
  LinearFlow flow_;
  Eigen::MatrixXd A_d_;
  Eigen::MatrixXd H_;
  Eigen::MatrixXd root_;  ///< U of P⁻¹ = U Uᵀ
  Eigen::MatrixXd at_zero_;

  StateLayout workspace_;
  VectorSlot transition_ = workspace_.vector(n_ * n_);
  VectorSlot moved_ = workspace_.vector(n_ * n_);     ///< e^{Aτ} U, a root of Ψ⁻¹
  VectorSlot measured_ = workspace_.vector(m_ * n_);  ///< H e^{Aτ} U
  VectorSlot basis_ = workspace_.vector(n_ * m_);     ///< its transpose, then orthonormal
  VectorSlot factor_ = workspace_.vector(m_ * m_);
  VectorSlot gain_ = workspace_.vector(m_ * n_);  ///< transposed, of A_d = I
  VectorSlot scratch_ = workspace_.vector(n_);
};

}  // namespace sampled_data_observers
