#pragma once

#include <algorithm>
#include <chrono>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// When to wake, by the steady clock, for an instant that a clock which may be set will show after
/// `wait`, read not before the steady clock showed `steady_now`. Never more than a second ahead:
/// who wakes too early asks again, and so a clock that was set is noticed.
inline std::chrono::steady_clock::time_point steady_deadline(
    Duration wait, std::chrono::steady_clock::time_point steady_now) {
  return steady_now + std::chrono::nanoseconds(std::min(wait, kNanosecondsPerSecond));
}

}  // namespace sampled_data_observers
