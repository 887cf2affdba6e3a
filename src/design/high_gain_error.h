#pragma once

#include <Eigen/Core>
#include <vector>

namespace sampled_data_observers {

/// How the error e = ẑ − z of the high-gain observer of bernard2022, example 4.3, moves, with one
/// chain of d entries: V = ε' P ε with ε_i = e_i/ℓ^(i−1), (A − K H)' P + P (A − K H) = −I, falls in
/// flow at least at the rate (ℓ − 2 |P B| |(c_i ℓ^(i−d))_i|)/λ_max(P) where Φ has no larger slopes
/// than c_i.
class HighGainError {
 public:
  /// @param K       d: k_1 … k_d, the zeros of whose polynomial lie in the open left half plane
  /// @param slopes  d: the c_i
  HighGainError(const Eigen::VectorXd& K, Eigen::VectorXd slopes);

  /// [1/s]; negative where V may grow.
  double flow_decay(double ell) const;

  /// ℓ_0 of example 4.3: from it on flow_decay() is positive. Infinite where slopes are.
  double sufficient_ell() const;

  /// By how much a jump multiplies V at most, ẑ⁺ − z⁺ = J e with one of these J, d x d each.
  double growth(const std::vector<Eigen::MatrixXd>& jumps, double ell) const;

  /// ℓ* of Corollary 4.1, to 5 %: from it on V falls from jump to jump, at least `dwell_time` [s]
  /// apart or an average dwell time. Infinite where there is none up to 10^4 times
  /// 1/dwell_time or sufficient_ell().
  double ell_for_jumps(const std::vector<Eigen::MatrixXd>& jumps, double dwell_time) const;

 private:
  Eigen::VectorXd slopes_;
  Eigen::MatrixXd P_;
  Eigen::MatrixXd root_;  ///< R with P = R' R
  Eigen::MatrixXd inverse_root_;
  double largest_;  ///< λ_max(P)
};

/// A − K H, companion: d x d.
Eigen::MatrixXd closed_loop_of(const Eigen::VectorXd& K);

}  // namespace sampled_data_observers
