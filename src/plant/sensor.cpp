#include "sampled_data_observers/plant/sensor.h"

#include <algorithm>
#include <cmath>

#include "sampled_data_observers/plant/ordered_product.h"

namespace sampled_data_observers {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

void compute_innovation(const Sensor& sensor, const double* y, const double* x,
                        double* innovation) {
  const Eigen::Index outputs = sensor.C.rows();
  if (innovation != y) std::copy_n(y, outputs, innovation);
  subtract_product(sensor.C, x, innovation);
  for (Eigen::Index i = 0; i < outputs; ++i) {
    if (sensor.angular[static_cast<std::size_t>(i)]) innovation[i] = wrap_angle(innovation[i]);
  }
}

}  // namespace sampled_data_observers
