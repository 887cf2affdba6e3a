#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

/// What a run was configured with: the guarantee, what the certificate says in single values
/// (theorem, rates, proof, ...), warnings, and the files as they are.
/// @throws OutputError where a file can't be read any more
nlohmann::json configuration_of(const ObserverConfig& config,
                                const std::vector<std::string>& files);

}  // namespace sampled_data_observers
