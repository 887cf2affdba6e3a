#pragma once

#include <optional>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Of a certified observer: a step times the largest rate at which its flow moves. One Runge–Kutta
/// step of order 4 is then off by less than 0.1^5 / 120 = 8.3e-8 of what it carries.
constexpr double kLongestCertifiedStep = 0.1;

/// Why Runge–Kutta steps of the configured length do not follow the flow of an observer, if so. The
/// flow moves at the rates of its Jacobian at the initial estimate, gains included; where the plant
/// states a Lipschitz constant, at those that it allows anywhere.
/// @param law         without decorators; a law that is flowed exactly passes
/// @param is_certified  whether steps must be accurate (kLongestCertifiedStep in balanced
///     coordinates), or only keep modes that decay from growing
std::optional<ConfigError> objection_to_step(ConfigSection& root, const Plant& plant,
                                             const ObserverLaw& law, bool is_certified);

}  // namespace sampled_data_observers
