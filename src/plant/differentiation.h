#pragma once

#include <Eigen/Core>

#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// J ← ∂map/∂x at x by central differences, with the step that balances rounding and truncation.
/// Allocates nothing.
/// @param x          n entries
/// @param scales     n entries: sizes of usual changes of x, for where x is small
/// @param J          map.size() x n, column-major
/// @param workspace  n + 2 map.size() entries
void differentiate(const VectorMap& map, const double* x, const double* u,
                   const Eigen::VectorXd& scales, double* J, double* workspace);

}  // namespace sampled_data_observers
