#include "tools/design/cross_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "design/lmi_solver.h"

namespace sampled_data_observers {

void cross_check(const DesignMethod& method, const Design& design, double time_limit) {
  const auto* lmi = dynamic_cast<const LmiDesignMethod*>(&method);
  if (lmi == nullptr) {
    throw DesignError("cross-check: " + method.name() + " is not one semidefinite program");
  }
  // What was solved for the largest T2 or decay is whether a given one is feasible.
  const Objective objective =
      design.objective == Objective::kMinGamma ? Objective::kMinGamma : Objective::kFeasible;
  const LmiProgram program = lmi->program(design.certificate.subject, design.parameters, objective);
  const LmiSolution solutions[] = {solve_with_interior_point(program),
                                   solve_lmi(program, time_limit),
                                   solve_with_sdpa(program, time_limit)};
  std::printf("cross-check of the semidefinite program of %s:\n", method.name().c_str());
  for (const LmiSolution& solution : solutions) {
    if (solution.values.empty()) {
      throw DesignError("cross-check: " + solution.solver +
                        " gave no solution: " + solution.message);
    }
    std::printf("  %s: objective %.9g, %s (%s), %.3f s\n", solution.solver.c_str(),
                solution.dual_objective, to_string(solution.status), solution.message.c_str(),
                solution.seconds);
  }
  const auto smaller = [](const LmiSolution& a, const LmiSolution& b) {
    return a.dual_objective < b.dual_objective;
  };
  const auto [least, largest] =
      std::minmax_element(std::begin(solutions), std::end(solutions), smaller);
  const double low = least->dual_objective;
  const double high = largest->dual_objective;
  std::printf("  they differ by %.2g %%\n",
              100.0 * (high - low) / std::max(std::abs(low), std::abs(high)));
}

}  // namespace sampled_data_observers
