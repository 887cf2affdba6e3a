#pragma once

#include <pthread.h>

#include <chrono>

namespace sampled_data_observers {

/// A mutex whose holder runs at the priority of the most urgent thread that waits for it, so that a
/// thread of real-time priority waits no longer than the work done under it. Lockable by
/// std::lock_guard and std::unique_lock. Where the system has no such mutexes it is a plain one.
class PriorityInheritanceMutex {
 public:
  PriorityInheritanceMutex();
  ~PriorityInheritanceMutex();
  PriorityInheritanceMutex(const PriorityInheritanceMutex&) = delete;
  PriorityInheritanceMutex& operator=(const PriorityInheritanceMutex&) = delete;

  /// Waits until no other thread holds it. @pre this thread does not hold it
  void lock() { pthread_mutex_lock(&mutex_); }
  /// Returns at once whether this thread holds it now.
  bool try_lock() { return pthread_mutex_trylock(&mutex_) == 0; }
  /// Waits so long at most, and returns whether this thread holds it now. Meanwhile its holder runs
  /// at this thread's priority. Where the system clock is set back meanwhile, by which such waits
  /// are measured, it may last until the holder lets go.
  bool try_lock_for(std::chrono::nanoseconds wait);
  /// @pre this thread holds it
  void unlock() { pthread_mutex_unlock(&mutex_); }

  /// For pthread_cond_wait() and its kin.
  pthread_mutex_t* native_handle() { return &mutex_; }

 private:
  pthread_mutex_t mutex_;
};

}  // namespace sampled_data_observers
