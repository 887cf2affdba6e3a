#include "sampled_data_observers/real_time/deadline_thread.h"

#include <ctime>
#include <future>
#include <map>
#include <system_error>
#include <utility>

#include "real_time/short_slices.h"

namespace sampled_data_observers {
namespace {

constexpr int kNoPriority = 0;

/// By the steady clock. Not std::condition_variable: before gcc 10 it waits by the system clock,
/// which may be set.
void make_steady(pthread_cond_t& condition) {
  pthread_condattr_t attributes;
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_cond_init(&condition, &attributes);
  pthread_condattr_destroy(&attributes);
}

}  // namespace

DeadlineThread::DeadlineThread(const std::string& name) {
  make_steady(changed_);
  make_steady(done_);
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
    const Lock lock(mutex_);
    stopping_ = true;
  }
  pthread_cond_signal(&changed_);
  thread_.join();
  pthread_cond_destroy(&done_);
  pthread_cond_destroy(&changed_);
}

std::shared_ptr<DeadlineThread> DeadlineThread::shared(const std::string& name,
                                                       std::optional<int> priority) {
  static std::mutex mutex;
  static std::map<int, std::weak_ptr<DeadlineThread>> threads;
  const std::lock_guard<std::mutex> lock(mutex);
  std::weak_ptr<DeadlineThread>& known = threads[priority.value_or(kNoPriority)];
  std::shared_ptr<DeadlineThread> thread = known.lock();
  if (!thread) {
    thread = std::make_shared<DeadlineThread>(name);
    known = thread;
  }
  return thread;
}

std::string DeadlineThread::set_real_time_priority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &parameters);
  return error == 0 ? "" : std::generic_category().message(error);
}

void DeadlineThread::run() {
  Lock lock(mutex_);
  while (!stopping_) {
    if (queue_.empty()) {
      pthread_cond_wait(&changed_, mutex_.native_handle());
      continue;
    }
    const Turn first = *queue_.begin();
    if (first.deadline > now_) now_ = Clock::now();
    if (first.deadline > now_) {
      wait_until(first.deadline);
    } else {
      do_task(*first.task, lock);
    }
  }
}

/// @pre the mutex is held, and the task is first in the queue
void DeadlineThread::do_task(DeadlineTask& task, Lock& lock) {
  task.node_ = queue_.extract(task.place_);
  task.woken_ = false;
  running_ = &task;
  lock.unlock();
  const Clock::time_point deadline = task.function_();
  lock.lock();
  running_ = nullptr;
  if (task.leaving_) {
    pthread_cond_broadcast(&done_);
  } else if (task.woken_ || deadline <= now_) {
    // Behind all that are due: one that is behind for long must not keep others from their turns.
    now_ = Clock::now();
    put(task, now_);
  } else {
    put(task, deadline);
  }
}

/// @pre the mutex is held, and the task is not in the queue
void DeadlineThread::put(DeadlineTask& task, Clock::time_point deadline) {
  Turn& turn = task.node_.value();
  turn.deadline = deadline;
  turn.number = ++turns_;
  task.place_ = queue_.insert(std::move(task.node_)).position;
}

/// Or until the queue has changed. @pre the mutex is held
void DeadlineThread::wait_until(Clock::time_point deadline) {
  const auto since_boot = deadline.time_since_epoch();
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(since_boot);
  timespec end{};
  end.tv_sec = seconds.count();
  end.tv_nsec = std::chrono::nanoseconds(since_boot - seconds).count();
  pthread_cond_timedwait(&changed_, mutex_.native_handle(), &end);
}

DeadlineTask::DeadlineTask(std::shared_ptr<DeadlineThread> thread, Function function)
    : thread_(std::move(thread)), function_(std::move(function)) {
  DeadlineThread::Queue made;
  node_ = made.extract(made.insert({Clock::time_point(), 0, this}).first);
  {
    const DeadlineThread::Lock lock(thread_->mutex_);
    thread_->put(*this, Clock::now());
  }
  pthread_cond_signal(&thread_->changed_);
}

DeadlineTask::~DeadlineTask() {
  const DeadlineThread::Lock lock(thread_->mutex_);
  leaving_ = true;
  while (thread_->running_ == this) {
    pthread_cond_wait(&thread_->done_, thread_->mutex_.native_handle());
  }
  if (node_.empty()) node_ = thread_->queue_.extract(place_);
}

void DeadlineTask::wake() {
  {
    const DeadlineThread::Lock lock(thread_->mutex_);
    woken_ = true;
    if (thread_->running_ == this) return;
    const Clock::time_point now = Clock::now();
    if (place_->deadline <= now) return;
    node_ = thread_->queue_.extract(place_);
    thread_->put(*this, now);
  }
  pthread_cond_signal(&thread_->changed_);
}

}  // namespace sampled_data_observers
