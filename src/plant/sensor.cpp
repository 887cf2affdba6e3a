#include "sampled_data_observers/plant/sensor.h"

#include <cmath>

namespace sampled_data_observers {
namespace {

constexpr double kHalfTurn = 3.14159265358979323846;

}  // namespace

const char* to_string(SensorTiming timing) {
  switch (timing) {
    case SensorTiming::kSampled:
      return "sampled";
    case SensorTiming::kContinuous:
      return "continuous";
    case SensorTiming::kAtJumps:
      break;
  }
  return "at_jumps";
}

double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kHalfTurn);
  return wrapped <= -kHalfTurn ? kHalfTurn : wrapped;
}

void wrap_angles(const std::vector<bool>& angular, double* values) {
  for (std::size_t i = 0; i < angular.size(); ++i) {
    if (angular[i]) values[i] = wrap_angle(values[i]);
  }
}

}  // namespace sampled_data_observers
