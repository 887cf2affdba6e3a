#pragma once

#include <string>

/// The files of src/replay/report/page, which CMake puts into the program.
namespace sampled_data_observers::page_parts {

std::string frame();
std::string style();
std::string script();

}  // namespace sampled_data_observers::page_parts
