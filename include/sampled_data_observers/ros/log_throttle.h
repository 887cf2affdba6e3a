#pragma once

#include <chrono>
#include <optional>

namespace sampled_data_observers {

/// Lets what is said again and again through now and then: one for each cause, so that none hides
/// another. It goes by the steady clock, since ROS time may stand still.
class LogThrottle {
 public:
  /// Whether it is to be said now.
  bool admits() {
    const Clock::time_point now = Clock::now();
    if (last_ && now - *last_ < kPeriod) return false;
    last_ = now;
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPeriod{5};

  std::optional<Clock::time_point> last_;
};

}  // namespace sampled_data_observers
