#pragma once

#include <functional>
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
/// bounded time of one event or one estimate only. It watches the clock for them.
class SharedRuntime {
 public:
  /// Exclusive use of the runtime, at one instant of ROS time, as long as it lives.
  class Access {
   public:
    explicit Access(SharedRuntime& shared);
    ~Access();
    Access(const Access&) = delete;
    Access& operator=(const Access&) = delete;

    Stamp now() const { return now_; }
    ObserverRuntime* operator->() const { return shared_.runtime_.get(); }
    ObserverRuntime& operator*() const { return *shared_.runtime_; }

   private:
    SharedRuntime& shared_;
    std::unique_lock<PriorityInheritanceMutex> lock_;
    Stamp now_;
    /// How far time went back since the use before, where that is more than the tolerance.
    Duration went_back_ = 0;
  };

  /// @param log            of the nodelet
  /// @param reset_service  to be called when time went back
  SharedRuntime(const ObserverConfig& config, NodeLog log, std::string reset_service);

  Access access() { return Access(*this); }

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
