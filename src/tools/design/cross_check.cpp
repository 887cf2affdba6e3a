#include "tools/design/cross_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "design/lmi_solver.h"
#include "files/output_file.h"

namespace sampled_data_observers {

namespace {

/// @param option  that asks for it
LmiProgram program_of(const DesignMethod& method, const Design& design, const char* option) {
  const auto* lmi = dynamic_cast<const LmiDesignMethod*>(&method);
  if (lmi == nullptr) {
    throw DesignError(option + (": " + method.name()) + " is not one semidefinite program");
  }
  // What was solved for the largest T2 or decay is whether a given one is feasible.
  const Objective objective =
      design.objective == Objective::kMinGamma ? Objective::kMinGamma : Objective::kFeasible;
  return lmi->program(design.certificate.subject, design.parameters, objective);
}

}  // namespace

void write_sdpa(const DesignMethod& method, const Design& design, const std::string& output) {
  write_output(output, sdpa_problem(program_of(method, design, "sdpa")));
}

void cross_check(const DesignMethod& method, const Design& design, double time_limit) {
  const LmiProgram program = program_of(method, design, "cross-check");
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
