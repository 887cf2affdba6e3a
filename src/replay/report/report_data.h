#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "replay/report/beside_run.h"
#include "replay/report/run_record.h"
#include "replay/report/seed_runs.h"
#include "replay/summary.h"
#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

/// All that the page of a report shows, as src/page/report reads it. Times are in seconds after
/// "origin", a stamp in seconds. What does not exist is null or missing.
///
/// Of a long run, estimates and what is compared are thinned (ThinnedSeries), and events that were
/// used as they should left out, so that the page stays below 15 MB.
/// @param files   the configuration's, as given
/// @param beside  replays of the same bag with other gains
/// @param seeds   replays with other seeds of the thinning, that of the record first; may be empty
/// @throws OutputError where one of them can't be read any more
nlohmann::json report_data(const ObserverConfig& config, const std::vector<std::string>& files,
                           const ReplaySummary& summary, const RunRecord& record,
                           const std::vector<BesideRun>& beside, const std::vector<SeedRun>& seeds);

}  // namespace sampled_data_observers
