#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "ranks/ranks.h"
#include "replay/report/packed_array.h"
#include "replay/report/report_verdict.h"
#include "replay/report/run_record.h"
#include "replay/summary.h"

namespace sampled_data_observers {

/// What is kept of a replay with another seed of the thinning: how the norm of its errors went.
struct SeedRun {
  std::uint64_t seed = 0;
  std::vector<Stamp> stamps;
  std::vector<double> norms;  ///< one per stamp
  std::optional<double> rmse;
  std::optional<double> largest;      ///< norm
  std::optional<double> bound_share;  ///< the largest that an error took; nothing without a bound
  bool is_guarantee_broken = false;
};

SeedRun seed_run(std::uint64_t seed, const ReplaySummary& summary, const RunRecord& record);

/// On rank 0 the runs of all ranks, in their order, elsewhere none.
std::vector<SeedRun> gathered_runs(Ranks& ranks, const std::vector<SeedRun>& own);

/// The least, the median and the largest norm of the errors over all seeds.
struct SeedBand {
  std::vector<Stamp> stamps;
  std::vector<double> low;
  std::vector<double> middle;
  std::vector<double> high;
};

/// At each stamp that all of them compared.
SeedBand seed_band(const std::vector<SeedRun>& runs);

/// @pre runs is not empty
ReportFinding finding_over(const std::vector<SeedRun>& runs);

/// The band over time, and a row for each seed.
nlohmann::json seeds_of(const std::vector<SeedRun>& runs, const PackedTime& time);

}  // namespace sampled_data_observers
