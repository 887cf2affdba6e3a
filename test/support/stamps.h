#pragma once

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers::test {

inline constexpr Duration kSecond = kNanosecondsPerSecond;
inline constexpr Duration kMillisecond = kSecond / 1000;

/// As large as the stamps of these years are: what does not tell nanoseconds of them apart shows.
inline constexpr Stamp kStart = 1'600'000'000'000'000'000;

}  // namespace sampled_data_observers::test
