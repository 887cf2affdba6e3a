#pragma once

#include <string>
#include <vector>

#include "design/sweep.h"

namespace sampled_data_observers {

/// What draw_sweep() writes into the folder.
std::vector<std::string> names_of_pictures();

/// The curves as pictures, and the page with curves and points.
void draw_sweep(const SweepRequest& request, const std::vector<CurvePoint>& curves,
                const std::vector<SweepPoint>& points, const std::string& plant_file,
                const std::string& folder);

/// For each method at how many T2 there is a design, and the values of the first and the last.
void print_summary(const SweepRequest& request, const std::vector<CurvePoint>& curves);

}  // namespace sampled_data_observers
