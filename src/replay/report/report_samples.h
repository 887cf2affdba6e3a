#pragma once

#include <nlohmann/json.hpp>

#include "replay/report/packed_array.h"
#include "replay/report/run_record.h"
#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

/// What was measured of each column, with what became of it. Of very many samples, some of those
/// that were used as the newest are left out.
nlohmann::json samples_of(const ObserverConfig& config, const RunRecord& record,
                          const PackedTime& time);

/// The times between the samples of each sensor that is sampled, as they were taken: over time,
/// thinned where there are very many, and how often each occurs, of all.
nlohmann::json sensors_of(const ObserverConfig& config, const RunRecord& record,
                          const PackedTime& time);

}  // namespace sampled_data_observers
