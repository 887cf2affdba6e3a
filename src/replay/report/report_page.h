#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sampled_data_observers {

/// A page that shows a report, all in one file: it asks no network for anything, and runs no script
/// but its own, whatever the texts in the data are.
std::string report_page(const nlohmann::json& data);

}  // namespace sampled_data_observers
