#include "design/threads.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "design/arb.h"
#include "design/work_limit.h"

namespace sampled_data_observers {
namespace {

ThreadOutcome outcome_of(const std::function<void(std::size_t)>& task, std::size_t number,
                         double time_limit) {
  const WorkLimit limit(time_limit);
  try {
    task(number);
    // Also where it has come to its end: the limit decides, not who looks first.
    require_time_left();
    return {};
  } catch (const OutOfTime&) {
    return {ThreadOutcome::Status::kTimedOut, ""};
  } catch (const std::exception& fault) {
    return {ThreadOutcome::Status::kThrew, fault.what()};
  }
}

}  // namespace

std::vector<ThreadOutcome> run_in_threads(std::size_t count,
                                          const std::function<void(std::size_t)>& task,
                                          const ThreadOptions& options) {
  std::vector<ThreadOutcome> outcomes(count);
  std::atomic<std::size_t> next{0};
  std::mutex telling;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      outcomes[i] = outcome_of(task, i, options.time_limit);
      if (!options.on_done) continue;
      const std::lock_guard<std::mutex> lock(telling);
      options.on_done();
    }
  };
  std::vector<std::thread> others;
  for (std::size_t k = 1; k < std::min<std::size_t>(options.jobs, count); ++k) {
    others.emplace_back([&] {
      work();
      ::flint_cleanup();  // what arb keeps for this thread
    });
  }
  work();
  for (std::thread& other : others) other.join();
  return outcomes;
}

}  // namespace sampled_data_observers
