#pragma once

#include <string>

/// The files of src/page/report, which CMake puts into the program.
namespace sampled_data_observers::page_parts {

/// What makes the page of report_data(), for html_page().
std::string report();

}  // namespace sampled_data_observers::page_parts
