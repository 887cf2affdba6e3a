#pragma once

#include <cstdint>
#include <limits>

namespace sampled_data_observers {

/// A point in time: integer nanoseconds since the epoch of the clock in use. Positive when valid.
using Stamp = std::int64_t;

/// A length of time in integer nanoseconds.
using Duration = std::int64_t;

/// 1 s as a Duration.
constexpr Duration kNanosecondsPerSecond = 1000000000;

/// Seconds, for formulas and people. Never fed back into a Stamp.
constexpr double to_seconds(Duration duration) { return static_cast<double>(duration) * 1e-9; }

/// The nearest whole number of nanoseconds.
/// @pre |seconds| < 9.2e9, so that the result is representable.
constexpr Duration from_seconds(double seconds) {
  return static_cast<Duration>(seconds * 1e9 + (seconds < 0.0 ? -0.5 : 0.5));
}

/// A longest time that is none: nothing is longer.
constexpr Duration kNoLongestTime = std::numeric_limits<Duration>::max();

/// The same for a longest time, which may be infinite.
constexpr Duration longest_from_seconds(double seconds) {
  return seconds == std::numeric_limits<double>::infinity() ? kNoLongestTime
                                                            : from_seconds(seconds);
}
/// Seconds of a longest time, infinite for none.
constexpr double longest_to_seconds(Duration longest) {
  return longest == kNoLongestTime ? std::numeric_limits<double>::infinity() : to_seconds(longest);
}

/// The smallest whole multiple of `period` that is not less than `stamp`.
/// @pre stamp >= 0 and period > 0
constexpr Stamp first_multiple_from(Stamp stamp, Duration period) {
  return stamp % period == 0 ? stamp : (stamp / period + 1) * period;
}

}  // namespace sampled_data_observers
