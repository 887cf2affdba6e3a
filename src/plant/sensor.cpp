#include "sampled_data_observers/plant/sensor.h"

#include <cmath>

namespace sampled_data_observers {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace sampled_data_observers
