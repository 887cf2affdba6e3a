#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace sampled_data_observers {

/// w(duration) of ẇ = growth w + push, w(0) = start; infinity stays.
inline double flowed_linearly(double start, double growth, double push, double duration) {
  if (std::isinf(start)) return start;
  const double z = growth * duration;
  double integral = duration;  // of e^{growth s}
  if (std::abs(z) >= 1e-16) {
    integral = std::expm1(z) / growth;
  } else if (growth != 0.0) {
    // The quotient may be lost in underflow; duration (1 + z/2 + …) never is.
    integral *= 1.0 + 2.5e-16;
  }
  return start * std::exp(z) + push * integral;
}

/// Not less than w(duration) of ẇ = growth w + s, w(0) = 0, s the time:
/// duration²/2 (1 + z/3 + z²/12 + …), z = growth duration.
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
  constexpr double kSmall = 1e-8;
  if (rate > 0.0 && duration > 0.0 && rate * duration < kSmall) {
    // A final level that is large and hardly approached must not be subtracted from itself.
    const double z = std::max(rate * duration, std::numeric_limits<double>::min());
    return start + (final - start) * -std::expm1(-z);
  }
  return final + (start - final) * std::exp(-rate * duration);
}

}  // namespace sampled_data_observers
