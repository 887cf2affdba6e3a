#pragma once

#include <cstdint>
#include <string>

#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

/// How the example recording is made.
struct RecordingOptions {
  double duration = 40.0;  ///< s
  std::uint64_t seed = 1;
  double latency = 0.05;  ///< longest time from a sample's stamp to its arrival [s]
  double noise = 0.0;     ///< half width of the uniform noise on each output
};

/// Simulates the plant of a configuration and records what a robot would have: its sensors' samples
/// at random times in [T1, T2] with random latencies (thus behind newer inputs; one in twenty sent
/// twice), its input u(t) = sin t held for 20 ms each, and the true state, on the topic `truth`.
/// Every state starts at 1. The simulation is exact: the input is piecewise constant.
/// @throws ReplayError when the bag can't be written, or a sensor's source is no Measurement.
void record_example(const ObserverConfig& config, const RecordingOptions& options,
                    const std::string& path);

}  // namespace sampled_data_observers
