#pragma once

#include <string>
#include <vector>

#include "replay/report/run_record.h"
#include "replay/summary.h"

namespace sampled_data_observers {

/// A replay of the same bag with other gains, which a report shows beside the one that it is about.
struct BesideRun {
  std::string name;  ///< that of the gain file
  ReplaySummary summary;
  RunRecord record;
};

/// The files of a configuration with another one in the place of that which has the key `gains`.
/// @throws ReplayError where none of them has
std::vector<std::string> with_gains(std::vector<std::string> files, const std::string& gains);

}  // namespace sampled_data_observers
