#pragma once

#include <functional>

#include "design/design_search.h"

namespace sampled_data_observers {

/// Solves a problem of a theorem whose Lyapunov function depends on timers on a growing grid of
/// them: from few cells on, those at which a condition is active are halved, until that gains less
/// than 1 %, or the grid is so large that a program would take too long. Where the subject has
/// timer_nodes, and for other theorems, it is solved once.
/// @param solve  for a subject; throws DesignError where it finds nothing
/// @throws DesignError  of the finest grid, where none has a solution
Design solve_on_refined_cells(const Theorem& theorem, const CertificateSubject& subject,
                              Objective objective, const ErrorAssumptions& assumptions,
                              const std::function<Design(const CertificateSubject&)>& solve);

}  // namespace sampled_data_observers
