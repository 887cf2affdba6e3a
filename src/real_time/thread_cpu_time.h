#pragma once

#include <ctime>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// CPU time that the calling thread has taken so far [ns].
inline Duration thread_cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<Duration>(time.tv_sec) * kNanosecondsPerSecond + time.tv_nsec;
}

}  // namespace sampled_data_observers
