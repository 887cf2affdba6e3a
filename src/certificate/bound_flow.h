#pragma once

#include <cmath>

namespace sampled_data_observers {

/// w(duration) of ẇ = growth w + push, w(0) = start; infinity stays.
inline double flowed_linearly(double start, double growth, double push, double duration) {
  if (std::isinf(start)) return start;
  const double integral =
      growth == 0.0 ? duration : std::expm1(growth * duration) / growth;  // of e^{growth s}
  return start * std::exp(growth * duration) + push * integral;
}

/// Not less than w(duration) of ẇ = growth w + s, w(0) = 0, s the time: duration²/2 (1 + z/3 +
/// z²/12
/// + …), z = growth duration.
inline double integral_of_ramp(double growth, double duration) {
  constexpr double kSmall = 0.5;
  constexpr int kTerms = 16;  // what they leave out is less than 1e-19 of the sum
  const double z = growth * duration;
  double ratio = 0.0;  // of the integral to duration²
  if (std::abs(z) > kSmall) {
    ratio = (std::expm1(z) - z) / (z * z);
  } else {
    double term = 0.5;
    for (int k = 3; k < kTerms + 3; ++k) {
      ratio += term;
      term *= z / k;
    }
  }
  return ratio * duration * duration * (1.0 + 1e-12);
}

/// w(duration) of ẇ = −rate (w − final), w(0) = start
inline double decayed(double start, double final, double rate, double duration) {
  return final + (start - final) * std::exp(-rate * duration);
}

}  // namespace sampled_data_observers
