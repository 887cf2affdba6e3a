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

/// d, the number of gains in each mode, of a form for one output.
/// @throws std::invalid_argument for other than one continuous output, and modes that differ in d.
Eigen::Index order_of_one_output(const HighGainSettings& settings, const Plant& plant);

/// ℓ 𝓛(ℓ) K for each mode, as scaled_gain() has it.
/// @throws std::invalid_argument as order_of_one_output() and scaled_gain().
std::vector<Eigen::VectorXd> scaled_gains(const HighGainSettings& settings, const Plant& plant);

/// ell, K (K/1, K/2, … where there are several), saturations/state and `maps`, which are formulas;
/// of a switched plant modes/label/K and so on.
LawGains list_gains(const HighGainSettings& settings, const Plant& plant,
                    const std::vector<std::string>& maps);

}  // namespace sampled_data_observers
