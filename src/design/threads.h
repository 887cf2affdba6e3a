#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// What became of one task.
struct ThreadOutcome {
  enum class Status { kDone, kThrew, kTimedOut };
  Status status = Status::kDone;
  /// Of what it threw.
  std::string message;
};

struct ThreadOptions {
  unsigned jobs = 1;
  /// For a task, by WorkLimit [s].
  double time_limit = 10.0;
  /// Called after each task, by one thread at a time.
  std::function<void()> on_done;
};

/// Runs task(0), …, task(count - 1) in threads, `jobs` at a time, the calling one among them. A
/// task that throws, or takes too long, costs its own outcome only.
std::vector<ThreadOutcome> run_in_threads(std::size_t count,
                                          const std::function<void(std::size_t)>& task,
                                          const ThreadOptions& options);

}  // namespace sampled_data_observers
