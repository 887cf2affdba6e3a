#pragma once

#include <functional>
#include <string>

#include "design/workers.h"
#include "ranks/ranks.h"

namespace sampled_data_observers {

// Tasks in worker processes of all ranks, `jobs` at a time on each: whoever is free takes the next
// one. Rank 0 calls lead_tasks(), which gives them out and is told all outcomes, the others
// follow_tasks().

/// @param request  what is asked for, which must be the same on all ranks
/// @param options  on_outcome and is_cancelled as for run_in_workers(), for the tasks of all ranks
/// @throws std::runtime_error where a rank has another request, and as run_tasks()
void lead_tasks(Ranks& ranks, const std::string& request, const NextTask& next,
                const std::function<std::string(std::size_t)>& task, const WorkerOptions& options);

/// Returns when there is no task left to take.
/// @throws as run_tasks()
void follow_tasks(Ranks& ranks, const std::string& request,
                  const std::function<std::string(std::size_t)>& task,
                  const WorkerOptions& options);

}  // namespace sampled_data_observers
