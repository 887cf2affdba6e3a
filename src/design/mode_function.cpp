#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>

#include "design/polytopic_embedding.h"

namespace sampled_data_observers {
namespace {

constexpr double kPi = boost::math::constants::pi<double>();

/// f' = t^{p−1} e^{σt} √((p + σt)² + (ωt)²)/p! cos ψ(t), for ω > 0, with a phase ψ that never
/// falls.
double phase(const ModeFunction& f, double t) {
  const double shift = f.is_sine ? kPi / 2.0 : 0.0;
  const double turn = f.power == 0 ? std::atan2(f.frequency, f.rate)
                                   : std::atan2(f.frequency * t, f.power + f.rate * t);
  return f.frequency * t - shift + turn;
}

/// The t in [low, high] of a phase between those of the ends.
double time_of_phase(const ModeFunction& f, double value, double low, double high) {
  if (f.power == 0) return std::clamp(low + (value - phase(f, low)) / f.frequency, low, high);
  for (;;) {
    const double middle = (low + high) / 2.0;
    if (!(low < middle && middle < high)) return middle;
    (phase(f, middle) < value ? low : high) = middle;
  }
}

}  // namespace

double ModeFunction::at(double t) const {
  double value = std::exp(rate * t);
  for (int i = 1; i <= power; ++i) value *= t / i;
  if (frequency == 0.0) return value;
  return value * (is_sine ? std::sin(frequency * t) : std::cos(frequency * t));
}

ModeFunction::Extrema ModeFunction::extrema(double low, double high) const {
  Extrema result{std::min(at(low), at(high)), std::max(at(low), at(high))};
  const auto include = [&](double t) {
    const double value = at(t);
    result.min = std::min(result.min, value);
    result.max = std::max(result.max, value);
  };
  // Where f has no derivative, its size is largest at −p/σ: it rises before and falls after.
  double peak = high;
  if (rate < 0.0) peak = std::clamp(-power / rate, low, high);
  if (frequency == 0.0) {
    include(peak);
    return result;
  }
  const auto turn_before = [&](double t) { return std::floor(phase(*this, t) / kPi - 0.5); };
  const double first = turn_before(low) + 1.0;
  const double last = turn_before(high);
  const double at_peak = turn_before(peak);
  const double first_near_peak = std::max(first, at_peak - 1.0);
  for (int i = 0; i < 4 && first_near_peak + i <= std::min(last, at_peak + 2.0); ++i) {
    include(time_of_phase(*this, (first_near_peak + i + 0.5) * kPi, low, high));
  }
  return result;
}

}  // namespace sampled_data_observers
