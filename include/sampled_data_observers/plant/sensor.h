#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// A sensor of a linear plant: y = C x, with m outputs.
struct Sensor {
  std::string name;
  /// m x n
  Eigen::MatrixXd C;
  /// m entries: whether the output is an angle [rad], so that its innovation is wrapped.
  std::vector<bool> angular;
};

/// The angle in (-π, π] that differs from `angle` by a whole number of turns.
double wrap_angle(double angle);

/// innovation = y - C x, angular outputs wrapped to (-π, π]. `y` and `innovation`: m entries.
inline void compute_innovation(const Sensor& sensor, const double* y, const double* x,
                               double* innovation) {
  const Eigen::Index outputs = sensor.C.rows();
  const Eigen::Index states = sensor.C.cols();
  for (Eigen::Index i = 0; i < outputs; ++i) {
    // Left to right, for the reason given at add_product().
    const double* entry = sensor.C.data() + i;
    double difference = y[i];
    for (Eigen::Index j = 0; j < states; ++j, entry += outputs) difference -= *entry * x[j];
    innovation[i] =
        sensor.angular[static_cast<std::size_t>(i)] ? wrap_angle(difference) : difference;
  }
}

}  // namespace sampled_data_observers
