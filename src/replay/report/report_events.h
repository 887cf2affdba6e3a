#pragma once

#include <nlohmann/json.hpp>

#include "replay/report/packed_array.h"
#include "replay/report/run_record.h"

namespace sampled_data_observers {

/// The events of a run as arrays with an entry each, in the order of their arrival. Of very many,
/// those that were used at once, and inside their times, are left out ("left_out"), then the last.
nlohmann::json events_of(const RunRecord& record, const PackedTime& time);

}  // namespace sampled_data_observers
