#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sampled_data_observers {

/// JSON as text; of file names and other texts that are not UTF-8, as far as they are.
inline std::string json_text(const nlohmann::json& json, int indent = -1) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace sampled_data_observers
