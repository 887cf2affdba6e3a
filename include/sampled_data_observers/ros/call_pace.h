#pragma once

#include <algorithm>
#include <chrono>
#include <mutex>

namespace sampled_data_observers {

/// Holds up who calls services again and again: in the long run they answer so often a second, and
/// what calls take of processors (a connection each, a question to the master, the caller itself)
/// is not taken from estimates. A few calls in a row go through at once.
class CallPace {
 public:
  /// Of the turns.
  using Clock = std::chrono::steady_clock;

  /// When a call that came at `now` is to be answered: once 50 ms from the call before in the long
  /// run, at once for ten calls after a rest.
  Clock::time_point turn(Clock::time_point now) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const Clock::time_point at = std::max(next_, now - kAtOnce * kInterval);
    next_ = at + kInterval;
    return at;
  }

 private:
  static constexpr std::chrono::milliseconds kInterval{50};
  static constexpr int kAtOnce = 9;  // and the one that comes now

  std::mutex mutex_;
  Clock::time_point next_;  ///< the turn of the next call, if calls do not rest
};

}  // namespace sampled_data_observers
