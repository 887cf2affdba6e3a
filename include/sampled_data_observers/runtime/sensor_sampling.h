#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sampled_data_observers/hybrid/event.h"

namespace sampled_data_observers {

/// The bounds T1 <= T2 on the time between two events [ns].
struct SamplingBounds {
  Duration T1 = 0;  ///< the shortest, >= 0
  Duration T2 = 0;  ///< the longest; kNoLongestTime where there is none
};

/// The times between samples of each sensor, or between jumps where there are no samples, for which
/// the gains were designed.
class SensorSampling {
 public:
  /// 0 at all times.
  SensorSampling() = default;

  /// The same for all sensors, or for jumps.
  SensorSampling(Duration T1, Duration T2) : common_{T1, T2} {}

  /// @param of_sensors  one for each sensor of the plant; nothing for those that are not sampled
  explicit SensorSampling(std::vector<std::optional<SamplingBounds>> of_sensors);

  /// Whether 0 <= T1 <= T2 for all of them.
  bool are_valid() const;

  /// Between two samples of a sensor that is sampled.
  /// @pre the plant has this sensor
  const SamplingBounds& of_sensor(std::size_t sensor) const {
    return of_sensors_.empty() ? common_ : *of_sensors_[sensor];
  }

  /// Between two events of a kind: of samples, those of the sensor.
  const SamplingBounds& of(EventKind kind, std::size_t sensor) const {
    return kind == EventKind::kSample ? of_sensor(sensor) : of_all();
  }

  /// From the least T1 to the largest T2 of all; between jumps where there are no samples.
  const SamplingBounds& of_all() const { return common_; }

 private:
  SamplingBounds common_;
  std::vector<std::optional<SamplingBounds>> of_sensors_;  ///< empty: common_
};

}  // namespace sampled_data_observers
