#pragma once

#include <chrono>
#include <mutex>

namespace sampled_data_observers {

/// Lets one caller of a service in at a time; the others wait a little, which slows down those that
/// call again and again, and are then to be told to come back.
class OneAtATime {
 public:
  /// The right to be in until it goes; it owns nothing where another caller stays in for longer
  /// than one waits.
  using Turn = std::unique_lock<std::timed_mutex>;

  /// Waits for 20 ms at most.
  Turn enter() { return Turn(mutex_, kPatience); }

 private:
  static constexpr std::chrono::milliseconds kPatience{20};

  std::timed_mutex mutex_;
};

}  // namespace sampled_data_observers
