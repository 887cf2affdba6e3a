#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "sampled_data_observers/real_time/priority_inheritance_mutex.h"

namespace sampled_data_observers {

class DeadlineTask;

/// A thread that does tasks (DeadlineTask), the most overdue one first: many that are due at the
/// same time cost one waking of the thread.
class DeadlineThread {
 public:
  /// Of the deadlines; no correction of the time of day moves it.
  using Clock = std::chrono::steady_clock;

  /// @param name  of the thread, as `top -H` shows it; at most 15 characters
  explicit DeadlineThread(const std::string& name);
  /// @pre no task is left
  ~DeadlineThread();
  DeadlineThread(const DeadlineThread&) = delete;
  DeadlineThread& operator=(const DeadlineThread&) = delete;

  /// The thread of this process for tasks of one priority, which all share who ask for that. The
  /// first one makes it, and it goes with the last one.
  /// @param name      where it is made now
  /// @param priority  to tell it from others only: see set_real_time_priority()
  static std::shared_ptr<DeadlineThread> shared(const std::string& name,
                                                std::optional<int> priority);

  /// Schedules the thread before all others of lower priority (SCHED_FIFO, 1 to 99).
  /// Returns why that is not possible, or an empty text.
  std::string set_real_time_priority(int priority);

 private:
  friend class DeadlineTask;

  /// When a task is to be done; those of the same time in the order in which they came.
  struct Turn {
    Clock::time_point deadline;
    std::uint64_t number;
    DeadlineTask* task;
    bool operator<(const Turn& other) const {
      return deadline != other.deadline ? deadline < other.deadline : number < other.number;
    }
  };
  /// A set, since its nodes can be taken out and put in again without an allocation.
  using Queue = std::set<Turn>;
  using Lock = std::unique_lock<PriorityInheritanceMutex>;

  void run();
  void do_task(DeadlineTask& task, Lock& lock);
  void put(DeadlineTask& task, Clock::time_point deadline);
  void wait_until(Clock::time_point deadline);

  PriorityInheritanceMutex mutex_;
  pthread_cond_t changed_;  ///< what is first in the queue, or stopping_
  pthread_cond_t done_;     ///< a task that is to go has ended
  Queue queue_;             ///< all tasks but the one that is being done
  std::uint64_t turns_ = 0;
  const DeadlineTask* running_ = nullptr;
  Clock::time_point now_;  ///< as last read by the thread, which alone uses it
  bool stopping_ = false;
  std::thread thread_;
};

/// What a DeadlineThread does again and again, each time at the deadline that the time before
/// named: an absolute time of the steady clock, so that no delay of one adds to the next. The
/// thread has others to do: the task is to wait for nothing that may take long.
class DeadlineTask {
 public:
  /// Of the deadlines.
  using Clock = DeadlineThread::Clock;
  /// Returns the next deadline; one that has passed means as soon as the others that are due had
  /// their turn. It must not throw.
  using Function = std::function<Clock::time_point()>;

  /// Has it done at once for the first time.
  /// @param thread    does it, beside the others that it has
  /// @param function  called on the thread only, never twice at a time
  DeadlineTask(std::shared_ptr<DeadlineThread> thread, Function function);
  /// Waits until the function, where it is running, has ended.
  ~DeadlineTask();
  DeadlineTask(const DeadlineTask&) = delete;
  DeadlineTask& operator=(const DeadlineTask&) = delete;

  /// Has it done at once, or once more where it is running.
  void wake();

 private:
  friend class DeadlineThread;

  const std::shared_ptr<DeadlineThread> thread_;
  const Function function_;
  // All else under the mutex of the thread.
  DeadlineThread::Queue::node_type node_;    ///< while it is not in the queue
  DeadlineThread::Queue::iterator place_{};  ///< while it is
  bool woken_ = false;
  bool leaving_ = false;
};

}  // namespace sampled_data_observers
