#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace sampled_data_observers {

/// Random numbers that are the same everywhere for one seed, which the distributions of the
/// standard library are not.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : generator_(seed) {}

  /// A generator of its own for each name: what one stream draws changes no other.
  RandomNumbers(std::uint64_t seed, const std::string& name) : generator_(mixed(seed, name)) {}

  /// A number in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1.0p-53;
  }

  /// A whole number in [low, high].
  std::int64_t whole(std::int64_t low, std::int64_t high) {
    const double drawn = uniform(static_cast<double>(low), static_cast<double>(high) + 1.0);
    return std::min(high, static_cast<std::int64_t>(std::floor(drawn)));
  }

  /// True with this probability.
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

  /// A normally distributed number with mean 0 and variance 1, by the ratio of uniforms (Kinderman
  /// and Monahan 1977). The C library's logarithm, which may differ in its last bit between
  /// machines, decides only whether a pair is taken; the number itself is an exactly rounded
  /// quotient.
  double gaussian() {
    constexpr double kHalfHeight = 0.857763884960707;  // sqrt(2 / e), rounded up
    for (;;) {
      const double u = 1.0 - uniform(0.0, 1.0);  // (0, 1]
      const double quotient = uniform(-kHalfHeight, kHalfHeight) / u;
      if (quotient * quotient <= -4.0 * std::log(u)) return quotient;
    }
  }

  /// An exponentially distributed number with mean 1, by comparisons alone (von Neumann 1951): a
  /// run of falling uniform numbers that begins with u has odd length with probability exp(-u).
  double exponential() {
    for (double whole = 0.0;; ++whole) {
      const double first = uniform(0.0, 1.0);
      bool is_odd = true;
      double last = first;
      for (double next = uniform(0.0, 1.0); next < last; next = uniform(0.0, 1.0)) {
        last = next;
        is_odd = !is_odd;
      }
      if (is_odd) return whole + first;
    }
  }

 private:
  /// FNV-1a of the name, then a finalizer (splitmix64), so that neighbouring seeds have nothing in
  /// common.
  static std::uint64_t mixed(std::uint64_t seed, const std::string& name) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    hash += seed * 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
    return hash ^ (hash >> 31);
  }

  std::mt19937_64 generator_;
};

}  // namespace sampled_data_observers
