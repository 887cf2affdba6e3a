#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/real_time/priority_inheritance_mutex.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/runtime/clock_jumps.h"
#include "sampled_data_observers/runtime/observer_runtime.h"
#include "sampled_data_observers/runtime/run_statistics.h"

namespace sampled_data_observers {

/// The runtime of a live observer, which several threads use: one at a time, and each for the
/// bounded time of one event or one estimate only. What takes longer, an integration over a while
/// without events, is done in parts of kSteps steps (ObserverRuntime::approach(), EstimateQuery),
/// each in a use of its own. It watches the clock for them.
class SharedRuntime {
 public:
  /// How many steps of an integration one use may take beside what it is for.
  static constexpr std::int64_t kSteps = 8;

  /// Tells when what is computed in parts is near enough to its end.
  class Parts {
   public:
    /// @param left  how many steps are left after those of this use
    /// @returns true as well where they do not become fewer, since others undo what was done: then
    /// it is to be done at once, or it would never be
    bool are_enough(std::int64_t left) {
      const bool enough = left == 0 || left >= last_;
      last_ = left;
      return enough;
    }

   private:
    std::int64_t last_ = std::numeric_limits<std::int64_t>::max();
  };

  /// Exclusive use of the runtime, at one instant of ROS time, as long as it lives.
  class Access {
   public:
    /// Waits for the thread that has it, then reads the clock. Where time went back, the runtime is
    /// told, if it is to start anew.
    explicit Access(SharedRuntime& shared);
    /// The same, but waits so long at most: is_there() says whether it is there.
    Access(SharedRuntime& shared, std::chrono::nanoseconds patience);
    /// Lets others have it, and says so where time went back.
    ~Access();
    Access(const Access&) = delete;
    Access& operator=(const Access&) = delete;

    /// Whether the runtime may be used: always, unless the wait for it was limited.
    bool is_there() const { return lock_.owns_lock(); }
    /// The instant of ROS time; 0 while a simulated clock has not begun.
    Stamp now() const { return now_; }
    /// The runtime; not to be kept beyond this access.
    ObserverRuntime* operator->() const { return shared_.runtime_.get(); }
    /// The same by reference.
    ObserverRuntime& operator*() const { return *shared_.runtime_; }

   private:
    void begin();

    SharedRuntime& shared_;
    std::unique_lock<PriorityInheritanceMutex> lock_;
    Stamp now_ = 0;
    /// How far time went back since the use before, where that is more than the tolerance.
    Duration went_back_ = 0;
  };

  /// @param config         what the runtime is built from
  /// @param log            of the nodelet
  /// @param reset_service  to be called when time went back
  SharedRuntime(const ObserverConfig& config, NodeLog log, std::string reset_service);

  /// Waits for the thread that uses the runtime now.
  Access access() { return Access(*this); }
  /// The same, so long at most.
  Access access_within(std::chrono::nanoseconds patience) { return Access(*this, patience); }

  /// Computes in parts what would take the next use long where it asks for the state at present.
  void approach_present();

  /// What to do, on whatever thread notices it, when time went back. To be set before the first
  /// event.
  void when_time_goes_back(std::function<void()> action) { time_went_back_ = std::move(action); }

  /// Goes on with the runtime `next`, which takes the present one over.
  void replace(std::unique_ptr<ObserverRuntime> next);

  /// For any thread, at any time.
  StatisticsRecorder& statistics() { return statistics_; }

 private:
  PriorityInheritanceMutex mutex_;
  std::unique_ptr<ObserverRuntime> runtime_;
  StatisticsRecorder statistics_;
  ClockJumps clock_;
  const bool reset_on_jump_back_;
  std::function<void()> time_went_back_;
  const NodeLog log_;
  const std::string reset_service_;
};

}  // namespace sampled_data_observers
