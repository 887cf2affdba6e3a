#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "sampled_data_observers/config/plant_config.h"

namespace sampled_data_observers {

/// What a plant file says to a design.
struct DesignConfig {
  std::shared_ptr<const Plant> plant;
  /// That formulas among the gains of an observer may use.
  ExpressionNames names;
  /// With N, C_p and, where given, T1 and T2 (else 0) or a dwell time.
  CertificateSubject subject;
  /// The section design/parameters.
  std::map<std::string, double> parameters;
  std::string plant_hash;
  /// Of the observer's section error_assumptions, where it says so.
  std::optional<double> noise;
  std::optional<double> disturbance;
};

/// Reads plant, sensors and the section `design` (sampling, N, C_p, weights, parameters, and A and
/// A_d, see StatedErrorMaps) of YAML files, and the observer's `sampling` and those of its sensors
/// where `design` has none, and noise and disturbance of `error_assumptions`; leaves the other
/// sections alone.
/// @throws ConfigError for the first fault found.
DesignConfig read_design_config(const std::vector<std::string>& files,
                                const PlantPluginLoader& load_plugin);

}  // namespace sampled_data_observers
