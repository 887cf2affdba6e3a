#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sampled_data_observers {

namespace page_parts {

// The files of page/, which CMake puts into the programs.
std::string frame();
std::string style();
std::string charts();

}  // namespace page_parts

/// A page for a browser that shows data by charts, all in one file: it asks no network for
/// anything, and runs no script but its own, whatever the texts in the data are.
/// @param script  what makes the page of the data, by what page_parts::charts() has
std::string html_page(const nlohmann::json& data, const std::string& script);

}  // namespace sampled_data_observers
