#include "sampled_data_observers/real_time/deadline_thread.h"

#include <ctime>
#include <future>
#include <mutex>
#include <system_error>
#include <utility>

#include "real_time/short_slices.h"

namespace sampled_data_observers {

DeadlineThread::DeadlineThread(Task task, const std::string& name) : task_(std::move(task)) {
  // Not std::condition_variable: before gcc 10 it waits by the system clock, which may be set.
  pthread_condattr_t attributes;
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_cond_init(&changed_, &attributes);
  pthread_condattr_destroy(&attributes);
  std::promise<void> scheduled;
  thread_ = std::thread([this, &scheduled] {
    ask_for_short_slices();
    scheduled.set_value();
    run();
  });
  scheduled.get_future().wait();  // else it might take back a priority that is set at once
  pthread_setname_np(thread_.native_handle(), name.c_str());
}

DeadlineThread::~DeadlineThread() {
  {
    const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
    stopping_ = true;
  }
  pthread_cond_signal(&changed_);
  thread_.join();
  pthread_cond_destroy(&changed_);
}

void DeadlineThread::wake() {
  {
    const std::lock_guard<PriorityInheritanceMutex> lock(mutex_);
    woken_ = true;
  }
  pthread_cond_signal(&changed_);
}

std::string DeadlineThread::set_real_time_priority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &parameters);
  return error == 0 ? "" : std::generic_category().message(error);
}

void DeadlineThread::run() {
  std::unique_lock<PriorityInheritanceMutex> lock(mutex_);
  while (!stopping_) {
    woken_ = false;
    lock.unlock();
    const Clock::time_point deadline = task_();
    lock.lock();
    wait_until(deadline);
  }
}

/// @pre the mutex is held
void DeadlineThread::wait_until(Clock::time_point deadline) {
  const auto since_boot = deadline.time_since_epoch();
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since_boot);
  timespec end{};
  end.tv_sec = seconds.count();
  end.tv_nsec = std::chrono::nanoseconds(since_boot - seconds).count();
  while (!woken_ && !stopping_ && Clock::now() < deadline) {
    pthread_cond_timedwait(&changed_, mutex_.native_handle(), &end);
  }
}

}  // namespace sampled_data_observers
