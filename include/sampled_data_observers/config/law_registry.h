#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/linear_plant.h"

namespace sampled_data_observers {

/// What every law is built from beside its gains.
struct LawContext {
  std::shared_ptr<const LinearPlant> plant;
  Eigen::VectorXd initial_estimate;
  Eigen::VectorXd initial_input;
};

/// Names of the observer types, as the key `observer` and the nodelets have them.
std::vector<std::string> observer_types();

/// Builds the law of an observer type from the section `gains`, reading all keys of it.
/// @pre type is one of observer_types()
/// @throws ConfigError for a fault in the gains.
std::shared_ptr<const ObserverLaw> build_law(const std::string& type, ConfigSection& gains,
                                             const LawContext& context);

}  // namespace sampled_data_observers
