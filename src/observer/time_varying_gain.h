#pragma once

#include <Eigen/Core>

#include "sampled_data_observers/hybrid/state_layout.h"

namespace sampled_data_observers {

/// A gain K(τ), n x m, of a sensor y = C x that depends on the time τ since the last sample.
///
/// Immutable; evaluate() allocates nothing and throws nothing.
class TimeVaryingGain {
 public:
  TimeVaryingGain() = default;
  TimeVaryingGain(const TimeVaryingGain&) = delete;
  TimeVaryingGain& operator=(const TimeVaryingGain&) = delete;
  virtual ~TimeVaryingGain() = default;

  /// Number of entries that evaluate() needs in `workspace`.
  virtual Eigen::Index workspace_size() const = 0;

  /// K ← K(τ). `backward`: e^{−Aτ}, n x n. The arguments do not overlap.
  virtual void evaluate(const double* backward, double* K, double* workspace) const = 0;
};

/// The gain (17) of sferlazza2019, for an invertible C:
///   K(τ) = (I − λ e^{−Aτ}) C⁻¹
///
/// Where e^{−Aτ} has an entry beyond 2^52, the rest of the error that λ would keep is rounding: the
/// gain is C⁻¹ then.
class InverseOutputGain : public TimeVaryingGain {
 public:
  /// @throws std::invalid_argument where C is not square and invertible.
  InverseOutputGain(const Eigen::MatrixXd& C, double lambda);

  Eigen::Index workspace_size() const override { return 0; }
  void evaluate(const double* backward, double* K, double* workspace) const override;

 private:
  double lambda_;
  Eigen::MatrixXd inverse_;  ///< C⁻¹
};

/// The gain of sferlazza2019 from a certificate P, (25) for λ = 0 and (36) with (37) otherwise, in
/// corrected form. With Ψ = e^{−Aᵀτ} P e^{−Aτ}, C⊥ an orthonormal complement of Cᵀ and
/// W = (C⊥ᵀ Ψ C⊥)⁻¹:
///   K(τ) = (Cᵀ − C⊥ W C⊥ᵀ Ψ Cᵀ − P⁻¹ M21) (C Cᵀ)⁻¹
///   M21 = λ R22ᵀ [R11; 0],  M11 = R11ᵀ R11,  M22 = R22ᵀ R22
///   M11 = C Ψ Cᵀ − C Ψ C⊥ W C⊥ᵀ Ψ Cᵀ,  M22 = P − P C⊥ W C⊥ᵀ P
///
/// M21 is 0, so that the gain is (25), where M22 is not positive definite: at τ = 0, and outside
/// the interval for which P is a certificate; also where e^{−Aτ} has an entry beyond 2^52, as for
/// InverseOutputGain. Where even W can't be computed, after a gap so long that e^{−Aτ} is not
/// finite, the gain is K(0).
class CertificateGain : public TimeVaryingGain {
 public:
  /// @param P  n x n, symmetric to the bit and positive definite
  /// @throws std::invalid_argument where C has not full row rank.
  CertificateGain(const Eigen::MatrixXd& C, const Eigen::MatrixXd& P, double lambda);

  Eigen::Index workspace_size() const override { return workspace_.size(); }
  void evaluate(const double* backward, double* K, double* workspace) const override;

 private:
  /// K (C Cᵀ) −= P⁻¹ M21, where M22 is positive definite.
  void subtract_kept_part(double* workspace) const;

  Eigen::Index n_;
  Eigen::Index m_;
  Eigen::Index q_;  ///< n - m
  double lambda_;
  Eigen::MatrixXd P_;
  Eigen::MatrixXd L_;             ///< P = L Lᵀ
  Eigen::MatrixXd L_transposed_;  ///< Lᵀ
  Eigen::MatrixXd basis_;         ///< [C⊥ Cᵀ], n x n
  Eigen::MatrixXd P_complement_;  ///< (P C⊥)ᵀ, q x n
  Eigen::MatrixXd gram_inverse_;  ///< (C Cᵀ)⁻¹, m x m
  Eigen::MatrixXd K_at_zero_;     ///< n x m

  StateLayout workspace_;
  VectorSlot root_ = workspace_.vector(n_ * n_);     ///< Lᵀ e^{−Aτ}, a root of Ψ
  VectorSlot rotated_ = workspace_.vector(n_ * n_);  ///< root [C⊥ Cᵀ]
  /// [L_W 0; Z L11] with C⊥ᵀ Ψ C⊥ = L_W L_Wᵀ, C Ψ C⊥ = Z L_Wᵀ, M11 = L11 L11ᵀ
  VectorSlot factor_ = workspace_.vector(n_ * n_);
  VectorSlot solved_ = workspace_.vector(q_ * m_);  ///< W C⊥ᵀ Ψ Cᵀ
  VectorSlot K_CCt_ = workspace_.vector(n_ * m_);   ///< K (C Cᵀ)
  VectorSlot M22_ = workspace_.vector(n_ * n_);
  VectorSlot Y_ = workspace_.vector(q_ * n_);  ///< L_W⁻¹ C⊥ᵀ P
  VectorSlot L11_ = workspace_.vector(m_ * m_);
  VectorSlot M21_ = workspace_.vector(n_ * m_);
};

}  // namespace sampled_data_observers
