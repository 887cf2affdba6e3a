#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "ranks/ranks.h"
#include "replay/replay.h"

namespace sampled_data_observers {

/// One of several runs, and what is told of it.
// NOLINTNEXTLINE(bugprone-exception-escape): moving JSON throws nothing
struct RunRow {
  std::string gains;  ///< the file; empty: that of the configuration
  std::uint64_t seed = 0;
  std::string bag;
  double bag_seconds = 0.0;
  double wall_seconds = 0.0;
  /// Errors where there is a truth, else the last estimate.
  std::vector<std::pair<std::string, std::optional<double>>> numbers;
  bool is_guarantee_broken = false;
  bool has_diverged = false;
  nlohmann::json summary;
};

RunRow row_of(const std::string& gains, std::uint64_t seed, const ReplaySummary& summary);

/// On rank 0 the rows of all ranks, in their order, elsewhere none.
std::vector<RunRow> gathered_rows(Ranks& ranks, const std::vector<RunRow>& own);

/// A line for each run, and for the runs of each gain file smallest, median and largest.
void print_runs(const std::vector<RunRow>& runs, bool has_seeds, std::ostream& out);

/// The same for machines, as JSON: `runs` with all summaries, `gains` with what is over seeds.
void write_runs(const std::vector<RunRow>& runs, bool has_seeds, const std::string& path);

}  // namespace sampled_data_observers
