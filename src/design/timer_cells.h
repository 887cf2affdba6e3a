#pragma once

#include <functional>

#include "design/design_search.h"

namespace sampled_data_observers {

/// Finds a design for a subject with timer_nodes; `coarser` is the best one on fewer of them, null
/// where there is none. Throws DesignError where it finds nothing.
using SolveOnGrid = std::function<Design(const CertificateSubject&, const Design* coarser)>;

/// Solves a problem of a theorem whose Lyapunov function depends on timers on a growing grid of
/// them: from few cells on, those at which a condition is active are halved, until that gains less
/// than 1 %, or the grid is so large that a program would take too long. Where the subject has
/// timer_nodes, and for other theorems, it is solved once. For the least final error a function
/// that falls at events is tried as well, unless the rate in flow is given (has_rate); which of
/// both is refined, the first grid tells.
/// @throws DesignError  of the finest grid, where none has a solution
Design solve_on_refined_cells(const Theorem& theorem, const CertificateSubject& subject,
                              Objective objective, const ErrorAssumptions& assumptions,
                              bool has_rate, const SolveOnGrid& solve);

}  // namespace sampled_data_observers
