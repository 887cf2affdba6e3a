#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// When a sensor measures.
enum class SensorTiming : std::uint8_t {
  kSampled,     ///< sporadically: each value is a sample
  kContinuous,  ///< all the time (y_c): a fast topic, each value held until the next
  kAtJumps      ///< at jumps of the plant only (y_d): the output just before the jump
};

/// As configurations have it: "sampled", "continuous" or "at_jumps".
const char* to_string(SensorTiming timing);

/// A sensor with m outputs. Its output map belongs to the plant, which may have one per mode.
struct Sensor {
  /// As configurations and event statuses have it.
  std::string name;
  /// Decides as events of which kind its values come.
  SensorTiming timing = SensorTiming::kSampled;
  /// m entries: whether the output is an angle [rad], so that its innovation is wrapped.
  std::vector<bool> angular;

  /// m
  Eigen::Index outputs() const { return static_cast<Eigen::Index>(angular.size()); }
};

/// The angle in (-π, π] that differs from `angle` by a whole number of turns.
double wrap_angle(double angle);

/// Wraps those values whose flag is set.
void wrap_angles(const std::vector<bool>& angular, double* values);

}  // namespace sampled_data_observers
