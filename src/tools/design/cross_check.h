#pragma once

#include <string>

#include "design/design_search.h"

namespace sampled_data_observers {

/// Writes the semidefinite program that led to a design in the SDPA sparse format.
/// @throws DesignError where the method is not one program
/// @throws OutputError where it can't be written
void write_sdpa(const DesignMethod& method, const Design& design, const std::string& output);

/// Solves the semidefinite program that led to a design once more with the three solvers, and
/// prints their objectives.
/// @param time_limit  for each [s]
/// @throws DesignError where the method is not one program, or the second solver gives no answer
void cross_check(const DesignMethod& method, const Design& design, double time_limit);

}  // namespace sampled_data_observers
