#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "observer/transformed_high_gain_observer.h"

namespace sampled_data_observers {

/// Where x̂ may stay although the plant is at x.
struct SecondEquilibrium {
  Eigen::VectorXd x;      ///< n
  Eigen::VectorXd x_hat;  ///< n: sat(Θ(ẑ))
  Eigen::VectorXd z_hat;  ///< d
};

/// Whether ℓ is large enough in one mode, found by trying points of the saturations' box:
/// estimates, no proofs.
struct EllCheck {
  int mode = 0;
  double ell = 0.0;
  std::size_t points = 0;
  /// Of the points, those where sat(Θ(T(x))) is inside of the box and T tells it again: what
  /// follows is about them.
  std::size_t regular = 0;

  /// Largest relative error of T_1 = h, T_i+1 = L_f T_i and Φ = L_f T_d at them, d + 1 entries.
  Eigen::VectorXd derivative_errors;
  /// d: largest |∂Φ/∂z_i| met.
  Eigen::VectorXd slopes;
  /// ℓ_0 of example 4.3: from it on ε' P ε with ε_i = (ẑ_i − z_i)/ℓ^(i−1) falls, where
  /// (A − K H)' P + P (A − K H) = −I, and Φ has no larger slopes than those:
  /// ℓ > 2 |P B| |(c_i ℓ^(i−d))_i|. Infinite where slopes are.
  double sufficient_ell = 0.0;

  // Where a dwell time is given:
  std::optional<double> dwell_time;  ///< [s]
  /// ℓ* of Corollary 4.1 for jumps that far apart, with these slopes of Φ and those of the jump map
  /// in z that were met; infinite where there is none.
  double ell_for_jumps = 0.0;
  double jump_growth = 0.0;  ///< by how much a jump multiplies V at `ell`

  /// The points that have a second equilibrium, and the one of them with ẑ farthest from z, in
  /// units of the box.
  std::size_t points_with_second = 0;
  std::optional<SecondEquilibrium> second;
  /// The least ℓ, to 5 %, from which on up to 1000 times it no point has one; nothing where there
  /// is none up to 1000 times the given one.
  std::optional<double> least_ell;
};

/// Second equilibria are looked for with the plant at rest at x, or slow against ℓ: the error
/// e = ẑ − T(x) stays where (A − ℓ 𝓛 K H) e + B δ = 0, δ = Φ(sat Θ(T(x) + e)) − Φ(x), which is one
/// equation in δ. Those count that hold ẑ: where the linearization is stable.
/// @param dwell_time  shortest time between jumps, or an average one [s]
/// @throws std::invalid_argument as points_of_box(), and for a dwell time of a plant that switches
/// or does not jump.
EllCheck check_ell(const TransformedHighGainObserver& law, std::size_t mode, std::size_t points,
                   std::optional<double> dwell_time = std::nullopt);

/// What they say in words, of at most 96 columns.
std::string ell_report(const TransformedHighGainObserver& law, const std::vector<EllCheck>& checks);

}  // namespace sampled_data_observers
