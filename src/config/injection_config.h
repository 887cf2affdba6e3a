#pragma once

#include <Eigen/Core>
#include <optional>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/observer/law_gains.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Reads the key `injection_lipschitz`, a map from states to numbers >= 0, of a law that injects
/// one output: ErrorAssumptions::injection_lipschitz. Nothing where it injects none.
/// @param section  `error_assumptions`
/// @param law      of at most one sensor that is injected
/// @param centre   near where the plant is, n entries
/// @throws ConfigError where it is missing, needless, or refuted by the plant's flow, and where the
/// output is no state of its own.
std::optional<Eigen::VectorXd> read_injection(ConfigSection& section, const LawGains& law,
                                              const Plant& plant, const Eigen::VectorXd& centre);

}  // namespace sampled_data_observers
