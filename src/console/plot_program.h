#pragma once

#include <string>

namespace sampled_data_observers {

/// Has a picture drawn (its format by the ending of `path`) by the python program that lies beside
/// this one, which reads what to draw as JSON.
/// @throws std::runtime_error when the picture can't be drawn.
void run_plot_program(const std::string& program, const std::string& json, const std::string& path);

}  // namespace sampled_data_observers
