#pragma once

#include <optional>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Whether all times in `inner` are in `outer`, in whole nanoseconds.
bool is_inside(const SamplingTimes& inner, const SamplingTimes& outer);

/// "[0.05, 0.2] s", for messages.
std::string to_text(const SamplingTimes& times);

/// What a configuration says of the times between events that correct an estimate.
struct SamplingConfig {
  /// Between two samples of each sensor of the plant, in their order; nothing for a sensor that is
  /// not sampled, and for one of which nothing is said.
  std::vector<std::optional<SamplingTimes>> sensors;
  /// Between two jumps of a plant without sampled sensors.
  std::optional<SamplingTimes> jumps;

  /// Whether nothing is said of any.
  bool is_empty() const;
};

/// Reads `sampling` of a section, where it is there: {T1, T2} for all sampled sensors, or for the
/// jumps of a plant without; or a map from names of sampled sensors to {T1, T2} of each.
/// @throws ConfigError for names that are no sampled sensor's, and times that are none
SamplingConfig read_sampling_section(ConfigSection& owner, const Plant& plant);

/// The same with sensors/NAME/sampling, which overrules `sampling` for its sensor. Where both are
/// there, those of the sensor lie inside those of `sampling`, for which the gains were made.
/// @param root  of the configuration
/// @throws ConfigError likewise
SamplingConfig read_sampling(ConfigSection& root, const Plant& plant);

/// @throws ConfigError where nothing is said of a sensor that is sampled
void require_sampling(ConfigSection& root, const Plant& plant, const SamplingConfig& sampling);

/// Takes the times of all sampled sensors, or of jumps, for those that a claim is about.
/// @pre not empty, and require_sampling() did not throw
void take_sampling(const SamplingConfig& sampling, CertificateSubject& subject);

/// An error at the times of a sensor: sensors/NAME/sampling, sampling/NAME or sampling.
ConfigError sampling_error(ConfigSection& root, const Sensor& sensor, const std::string& expected,
                           const std::string& found);

}  // namespace sampled_data_observers
