#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "design/design_method.h"

namespace sampled_data_observers {

/// The cost of each of several choices of the parameters; not finite where there is no solution.
using BatchCost = std::function<std::vector<double>(const std::vector<Parameters>&)>;

enum class SearchGoal { kLeastCost, kSmallCost, kAnySolution };

/// Searches for the parameters of least cost: a grid over all ranges first, then finer ones around
/// the best so far, until the cost changes by less than 0.1 %. Where the first grid has no
/// solution, one of twice as many points is tried. Without ranges, the one choice is tried. A small
/// cost ends it at changes by less than 3 %; any solution, with the first grid that has one.
/// @return how many choices were tried
std::size_t search_parameters(const std::vector<NamedRange>& ranges, SearchGoal goal,
                              const BatchCost& cost);

/// Each of `starts` with the value and its two neighbours within the range, at this distance: in
/// the logarithm where the range is logarithmic.
std::vector<Parameters> neighbours(const std::vector<Parameters>& starts, const NamedRange& named,
                                   double value, double distance);

}  // namespace sampled_data_observers
