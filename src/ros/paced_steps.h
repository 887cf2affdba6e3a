#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>

#include "real_time/thread_cpu_time.h"

namespace sampled_data_observers {

/// How much of a long computation is done in each use of the runtime: what takes its thread some
/// 50 µs of a processor. Between two uses it rests nine times as long: where a thread is preempted
/// that has the runtime, all others wait for it, so that should be rare. Time in which others had
/// the processor does not count: on a busy machine the computation would come down to a step at a
/// time.
class PacedSteps {
 public:
  /// @param steps  of the first part, > 0
  explicit PacedSteps(std::int64_t steps) : steps_(steps) {}

  /// To be computed between begin() and end().
  std::int64_t steps() const { return steps_; }
  /// A part begins, on the calling thread.
  void begin() { began_ = thread_cpu_time(); }
  /// It ends, on the same thread.
  void end() {
    took_ = thread_cpu_time() - began_;
    if (took_ < kPart / 2) {
      steps_ *= 2;
    } else if (took_ > kPart) {
      steps_ = std::max<std::int64_t>(1, steps_ / 2);
    }
  }
  /// Sleeps, for 5 ms at most.
  void rest() const {
    std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(9 * took_, kLongestRest)));
  }

 private:
  static constexpr Duration kPart = 50'000;
  static constexpr Duration kLongestRest = 5'000'000;

  std::int64_t steps_;
  Duration began_ = 0;
  Duration took_ = 0;
};

}  // namespace sampled_data_observers
