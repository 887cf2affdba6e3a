#pragma once

#include <cstdint>
#include <random>

namespace sampled_data_observers {

/// Uniform random numbers that are the same everywhere for one seed, which the distributions of the
/// standard library are not.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : generator_(seed) {}

  /// A number in [low, high).
  double in(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1.0p-53;
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace sampled_data_observers
