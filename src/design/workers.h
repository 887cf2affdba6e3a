#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// What became of one task.
struct WorkerOutcome {
  enum class Status { kDone, kThrew, kTimedOut, kCrashed };
  Status status = Status::kCrashed;
  /// The task's result, or the message of what it threw.
  std::string result;
  double seconds = 0.0;
};

struct WorkerOptions {
  unsigned jobs = 1;
  /// A task that takes longer is ended, with its process [s].
  double time_limit = 10.0;
  /// Called in the calling process after each task, with its number.
  std::function<void(std::size_t task, const WorkerOutcome& outcome)> on_outcome;
  /// Asked at least as often as `patience` says [s]; once it says yes, all workers are ended.
  std::function<bool()> is_cancelled;
  double patience = 0.2;
};

/// The number of the next task; nothing from when on there is none left.
using NextTask = std::function<std::optional<std::size_t>()>;

/// Tasks were given up because the caller said so.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

/// Number of processors.
unsigned default_jobs();

/// Runs task(0), …, task(count - 1) in forked processes, `jobs` at a time, and gives their outcomes
/// in this order. A task that hangs, crashes or throws costs its own outcome only. In a worker,
/// standard output is closed and the working directory is /. A task may itself run others in
/// workers. All end with the thread that calls, however that ends.
/// @pre where the calling process has other threads, the task takes no lock that one of them may
/// hold, but those of the C library
/// @throws std::system_error where no process can be started, Cancelled when told so
std::vector<WorkerOutcome> run_in_workers(std::size_t count,
                                          const std::function<std::string(std::size_t)>& task,
                                          const WorkerOptions& options);

/// The same for tasks that are known one by one; on_outcome tells what became of each.
void run_tasks(const NextTask& next, const std::function<std::string(std::size_t)>& task,
               const WorkerOptions& options);

}  // namespace sampled_data_observers
