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

/// innovation = y - C x, angular outputs wrapped to (-π, π]. `y` and `innovation`: m entries; they
/// may be the same array.
void compute_innovation(const Sensor& sensor, const double* y, const double* x, double* innovation);

}  // namespace sampled_data_observers
