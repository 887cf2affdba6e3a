#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "sampled_data_observers/real_time/priority_inheritance_mutex.h"

namespace sampled_data_observers {

/// A thread that does one task again and again, each time at the deadline that the time before
/// named: an absolute time of the steady clock, so that no delay of one adds to the next.
class DeadlineThread {
 public:
  /// Of the deadlines; no correction of the time of day moves it.
  using Clock = std::chrono::steady_clock;
  /// Returns the next deadline; one that has passed means at once. It must not throw.
  using Task = std::function<Clock::time_point()>;

  /// Runs the task at once for the first time.
  /// @param task  called on the thread only, never twice at a time
  /// @param name  of the thread, as `top -H` shows it; at most 15 characters
  DeadlineThread(Task task, const std::string& name);

  /// Waits until the task, where it is running, has ended.
  ~DeadlineThread();
  DeadlineThread(const DeadlineThread&) = delete;
  DeadlineThread& operator=(const DeadlineThread&) = delete;

  /// Has the task done at once, or once more where it is running.
  void wake();

  /// Schedules the thread before all others of lower priority (SCHED_FIFO, 1 to 99).
  /// Returns why that is not possible, or an empty text.
  std::string set_real_time_priority(int priority);

 private:
  void run();
  void wait_until(Clock::time_point deadline);

  const Task task_;
  PriorityInheritanceMutex mutex_;
  pthread_cond_t changed_;
  bool woken_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace sampled_data_observers
