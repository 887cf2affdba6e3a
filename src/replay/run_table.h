#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "replay/replay.h"

namespace sampled_data_observers {

/// One of several runs, and what was found.
struct NamedRun {
  std::string gains;  ///< the file; empty: that of the configuration
  std::uint64_t seed = 0;
  ReplaySummary summary;
};

/// A line for each run, and for the runs of each gain file smallest, median and largest.
void print_runs(const std::vector<NamedRun>& runs, bool has_seeds, std::ostream& out);

/// The same for machines, as JSON: `runs` with all summaries, `gains` with what is over seeds.
void write_runs(const std::vector<NamedRun>& runs, bool has_seeds, const std::string& path);

}  // namespace sampled_data_observers
