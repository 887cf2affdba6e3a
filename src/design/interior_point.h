#pragma once

#include <string>
#include <vector>

#include "design/lmi_solver.h"
#include "design/standard_form.h"

namespace sampled_data_observers {

struct InteriorPointOptions {
  int max_iterations = 100;
  /// Of the gap between the objectives and of both infeasibilities, each relative.
  double tolerance = 1e-8;
  /// A gap that is so small in proportion to the objective is enough, too, where that is less than
  /// 0: for programs that ask how far inside there is a solution, and need not know it exactly.
  double enough = 0.0;
};

/// What the method found, in the terms of LmiSolution.
struct InteriorPointResult {
  SolverStatus status = SolverStatus::kFailed;
  std::string message;
  int iterations = 0;
  /// The gap between the objectives, relative to them, that was left.
  double gap = 0.0;
  std::vector<double> x;
  double objective = 0.0;
  /// Bounds the objective from below.
  double dual_objective = 0.0;
};

/// Solves min c'x so that S = F_0 + Σ x_k F_k >= 0 by an infeasible primal-dual interior point
/// method: the direction of Helmberg, Rendl, Vanderbei and Wolkowicz, Kojima, Shindoh and Hara, and
/// Monteiro (HKM) with the predictor and corrector of Mehrotra (1992), as in Todd, Toh and Tütüncü
/// (1998). No state is shared: several may run at a time. The number of iterations, and so the
/// time, is bounded.
/// @throws OutOfTime (work_limit.h)
InteriorPointResult solve_by_interior_point(const StandardForm& form,
                                            const InteriorPointOptions& options);

}  // namespace sampled_data_observers
