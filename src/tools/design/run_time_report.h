#pragma once

#include "design/assumed_disturbance.h"
#include "design/design_search.h"

namespace sampled_data_observers {

/// Prints what a configuration without error_assumptions is designed for.
void print_assumptions(const DeclaredAssumptions& declared, const DesignProblem& problem,
                       const std::vector<std::string>& states);

/// Prints what the bound at run time does: in the end, from the start on, and how fast; with notes
/// where that is of little use.
void print_run_time_figures(const Design& design, const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers
