#pragma once

#include <string>
#include <vector>

#include "replay/report/beside_run.h"
#include "replay/report/run_record.h"
#include "replay/report/seed_runs.h"
#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

/// The names of the files that write_tables() writes into its folder.
std::vector<std::string> table_names();

/// All that a report shows, unthinned, as tables of comma-separated values in a folder, which is
/// made where it is missing. Stamps are in seconds, to the nanosecond; what does not exist is an
/// empty field.
/// @throws OutputError
void write_tables(const std::string& folder, const ObserverConfig& config, const RunRecord& record,
                  const std::vector<BesideRun>& beside, const std::vector<SeedRun>& seeds);

}  // namespace sampled_data_observers
