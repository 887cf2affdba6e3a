#pragma once

#include <limits>

namespace sampled_data_observers {

/// (2 h/π)², rounded up: the squared L2 gain of the integrator that each sample resets, for times
/// between samples up to h (etienne2019 (6)).
inline double wirtinger_constant(double h) {
  constexpr double kTwoByPi = 0.63661977236758134308;
  const double gain = h * kTwoByPi;
  return gain * gain * (1.0 + 4.0 * std::numeric_limits<double>::epsilon());
}

}  // namespace sampled_data_observers
