#include "sampled_data_observers/runtime/sensor_sampling.h"

#include <algorithm>
#include <utility>

namespace sampled_data_observers {
namespace {

bool is_valid(const SamplingBounds& bounds) { return 0 <= bounds.T1 && bounds.T1 <= bounds.T2; }

}  // namespace

SensorSampling::SensorSampling(std::vector<std::optional<SamplingBounds>> of_sensors)
    : common_{kNoLongestTime, 0}, of_sensors_(std::move(of_sensors)) {
  for (const auto& bounds : of_sensors_) {
    if (!bounds) continue;
    common_.T1 = std::min(common_.T1, bounds->T1);
    common_.T2 = std::max(common_.T2, bounds->T2);
  }
}

bool SensorSampling::are_valid() const {
  return is_valid(common_) &&
         std::all_of(of_sensors_.begin(), of_sensors_.end(),
                     [](const auto& bounds) { return !bounds || is_valid(*bounds); });
}

}  // namespace sampled_data_observers
