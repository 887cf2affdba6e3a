#pragma once

#include <Eigen/Core>
#include <optional>

namespace sampled_data_observers {

/// How far (21) of sferlazza2019 is known to hold.
struct IntervalVerification {
  bool holds = false;
  /// Where it is violated, or where the steps became too short to go on [s].
  std::optional<double> stopped_at;
  std::size_t steps = 0;
};

/// Whether Ξ_P(τ) > 0 for all τ in [T1, T2], those between the times looked at included.
///
/// By a Schur complement it is C⊥ᵀ Ψ(τ) C⊥ > C⊥ᵀ P C⊥ with Ψ(τ) = e^{−Aᵀτ} P e^{−Aτ}. For the least
/// β with Aᵀ P + P A <= 2 β P, the largest eigenvalue of the symmetric part of R A R⁻¹ where P = Rᵀ
/// R, Ψ(τ + s) >= e^{−2βs} Ψ(τ) for s >= 0. (Lemma 3 has −λ_min for λ_max, which is how Ψ falls at
/// most when it steps backwards.) So from one time on it holds for s < ln(r)/(2β), r the least
/// eigenvalue of the pencil of both sides there. This is Lemma 4 with a radius of its own at every
/// time and in the norm of P: the one in (57) is far too small where e^{−Aτ} is large, and, as (64)
/// has ‖e^{−Aτ}‖ for its square, not proved.
///
/// @param complement  C⊥, n x (n − m)
IntervalVerification verify_between(const Eigen::MatrixXd& A, const Eigen::MatrixXd& complement,
                                    const Eigen::MatrixXd& P, double T1, double T2);

}  // namespace sampled_data_observers
