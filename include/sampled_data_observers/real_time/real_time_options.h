#pragma once

#include <optional>

namespace sampled_data_observers {

/// What the thread that publishes estimates asks of the system.
struct RealTimeOptions {
  /// Of SCHED_FIFO, 1 to 99.
  std::optional<int> priority;
  /// Whether no memory of the process may be paged out.
  bool lock_memory = false;
};

}  // namespace sampled_data_observers
