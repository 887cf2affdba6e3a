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

/// w(duration) of ẇ = −rate (w − final), w(0) = start
inline double decayed(double start, double final, double rate, double duration) {
  return final + (start - final) * std::exp(-rate * duration);
}

}  // namespace sampled_data_observers
