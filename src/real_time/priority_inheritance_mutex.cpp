#include "sampled_data_observers/real_time/priority_inheritance_mutex.h"

#include <cstdint>
#include <ctime>

namespace sampled_data_observers {

PriorityInheritanceMutex::PriorityInheritanceMutex() {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  if (pthread_mutex_init(&mutex_, &attributes) != 0) pthread_mutex_init(&mutex_, nullptr);
  pthread_mutexattr_destroy(&attributes);
}

bool PriorityInheritanceMutex::try_lock_for(std::chrono::nanoseconds wait) {
  if (try_lock()) return true;
  constexpr std::int64_t kSecond = 1'000'000'000;
  timespec end{};
  clock_gettime(CLOCK_REALTIME, &end);
  const std::int64_t nanoseconds = end.tv_nsec + wait.count();
  end.tv_sec += nanoseconds / kSecond;
  end.tv_nsec = nanoseconds % kSecond;
  return pthread_mutex_timedlock(&mutex_, &end) == 0;
}

PriorityInheritanceMutex::~PriorityInheritanceMutex() { pthread_mutex_destroy(&mutex_); }

}  // namespace sampled_data_observers
