#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "observer/saturation.h"
#include "sampled_data_observers/observer/law_gains.h"

namespace sampled_data_observers {

/// What the three forms of a HighGainObserver have in common.
struct HighGainSettings {
  Saturation saturation;  ///< one entry per state of the plant
  double ell = 0.0;       ///< ℓ > 0, 1/s, of all modes
  /// The gains before scaling: per mode of the plant in its order, per continuous output.
  std::vector<std::vector<Eigen::VectorXd>> K;
};

/// @throws std::invalid_argument for saturations that do not fit, gains of other than the plant's
/// modes, and a plant without sensors.
void check_settings(const HighGainSettings& settings, const Plant& plant);

/// Where the chain of each continuous output, (h_j, L_f h_j, …), stands in z: the same in all
/// modes.
struct OutputChains {
  std::vector<Eigen::Index> first;  ///< m
  std::vector<Eigen::Index> last;   ///< m
  std::vector<bool> angular;        ///< m: whether the output is an angle

  std::size_t size() const { return first.size(); }
  /// Number of entries of z.
  Eigen::Index entries() const { return last.back() + 1; }
  /// innovation ← y_c less the outputs in z, angles wrapped: m entries
  void innovations(const double* y_c, const double* z, double* innovation) const;
};

/// @throws std::invalid_argument for K of other than one list for each continuous output, and modes
/// with lists of other lengths.
OutputChains chains_of(const HighGainSettings& settings, const Plant& plant);

/// For each mode blkdiag(ℓ 𝓛_j(ℓ) K_j), as scaled_gain() has each block: one row for each entry of
/// z, one column for each continuous output.
/// @throws std::invalid_argument as chains_of() and scaled_gain().
std::vector<Eigen::MatrixXd> scaled_gains(const HighGainSettings& settings, const Plant& plant);

/// The diagonal of 𝓛(ℓ)⁻¹ = blkdiag(𝓛_j(ℓ)⁻¹), 𝓛_j = diag(1, ℓ, …): 1 at the outputs.
Eigen::VectorXd inverse_powers(const HighGainSettings& settings, const Plant& plant);

/// ell, K (K/1, K/2, … where there are several), saturations/state and `maps`, which are formulas;
/// of a switched plant modes/label/K and so on.
LawGains list_gains(const HighGainSettings& settings, const Plant& plant,
                    const std::vector<std::string>& maps);

}  // namespace sampled_data_observers
