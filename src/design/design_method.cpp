#include "design/design_method.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "design/assumed_disturbance.h"
#include "design/certify.h"
#include "design/final_error.h"
#include "design/methods/methods.h"

namespace sampled_data_observers {

const char* to_string(Objective objective) {
  switch (objective) {
    case Objective::kFeasible:
      return "feasible";
    case Objective::kMinGamma:
      return "min-gamma";
    case Objective::kMaxT2:
      return "max-T2";
    case Objective::kMinT1:
      return "min-T1";
    case Objective::kMinFinalError:
      return "min-final-error";
    case Objective::kMaxDecay:
      break;
  }
  return "max-decay";
}

bool is_better(const DesignCandidate& a, const DesignCandidate& b) {
  if (a.values.empty()) return false;
  if (a.is_verified() != b.is_verified()) return a.is_verified();
  return a.is_verified() ? a.cost < b.cost : a.margin > b.margin;
}

DesignCandidate LmiDesignMethod::solve(const CertificateSubject& subject,
                                       const Parameters& parameters, Objective objective) const {
  DesignCandidate candidate;
  LmiSolution solution = solve_here(program(subject, parameters, objective), SolverOptions());
  const auto least = solution.values.find(kFinalErrorLevel);
  std::optional<double> level;
  if (objective == Objective::kMinFinalError && least != solution.values.end()) {
    // Gains at the very edge could hardly be proved.
    level = kFinalErrorRoom * least->second(0, 0);
    Parameters with_room = parameters;
    with_room[kFinalErrorLevel] = *level;
    solution = solve_here(program(subject, with_room, objective), SolverOptions());
  }
  candidate.solver = solution.solver;
  candidate.message = "the design's program " + why_unsolved(solution);
  if (solution.values.empty() || solution.status == SolverStatus::kInfeasible ||
      solution.status == SolverStatus::kUnbounded) {
    return candidate;
  }
  NamedMatrices values = gains(subject, parameters, solution.values);
  if (values.empty()) {
    candidate.message = "the solver left a bound";
    return candidate;
  }
  for (const NamedShape& shape : theorem().parameters(subject)) {
    const auto given = parameters.find(shape.name);
    if (given != parameters.end()) values[shape.name] = scalar_matrix(given->second);
  }
  for (const auto& shapes : {theorem().multipliers(subject), theorem().parameters(subject)}) {
    for (const NamedShape& shape : shapes) {
      const auto found = solution.values.find(shape.name);
      if (found == solution.values.end()) continue;
      const bool is_minimized = shape.name == "gamma" && objective == Objective::kMinGamma;
      values[shape.name] = (is_minimized ? kGammaInflation : 1.0) * found->second;
    }
  }
  candidate = judged(theorem(), subject, std::move(values), objective, std::move(candidate));
  if (level && candidate.is_verified()) {
    candidate.cost = final_error_of_level(theorem(), subject, candidate.values, *level);
  }
  return candidate;
}

DesignEstimate LmiDesignMethod::estimate_by_program(const CertificateSubject& subject,
                                                    const Parameters& parameters,
                                                    Objective objective) const {
  DesignEstimate estimate;
  const LmiSolution solution = solve_here(program(subject, parameters, objective));
  const bool is_of_use = !solution.values.empty() && solution.status != SolverStatus::kInfeasible &&
                         solution.status != SolverStatus::kUnbounded &&
                         (objective != Objective::kFeasible || solution.satisfies_all());
  if (!is_of_use) {
    estimate.message = "the design's program " + why_unsolved(solution);
    return estimate;
  }
  if (gains(subject, parameters, solution.values).empty()) {
    estimate.message = "the solver left a bound";
    return estimate;
  }
  estimate.cost = objective == Objective::kFeasible ? -solution.margin : solution.dual_objective;
  return estimate;
}

DesignCandidate LmiDesignMethod::attempt(const CertificateSubject& subject,
                                         const Parameters& parameters, Objective objective) const {
  DesignCandidate solved = solve(subject, parameters, objective);
  if (solved.values.empty()) return solved;
  DesignCandidate candidate = certified(subject, parameters, objective, solved);
  const auto gamma = solved.values.find("gamma");
  const bool is_at_edge =
      objective == Objective::kMinGamma && gamma != solved.values.end() && !candidate.is_verified();
  if (is_at_edge) {
    Parameters with_room = parameters;
    with_room["gamma"] = gamma->second(0, 0);
    const DesignCandidate inside = solve(subject, with_room, Objective::kFeasible);
    if (!inside.values.empty()) candidate = certified(subject, parameters, objective, inside);
  }
  return candidate;
}

/// With the gains of a solution, and the matrices that the theorem finds for them.
DesignCandidate LmiDesignMethod::certified(const CertificateSubject& subject,
                                           const Parameters& parameters, Objective objective,
                                           const DesignCandidate& solved) const {
  NamedMatrices fixed;
  for (const NamedShape& shape : theorem().gains(subject)) {
    fixed[shape.name] = solved.values.at(shape.name);
  }
  for (const NamedShape& shape : theorem().parameters(subject)) {
    const auto given = parameters.find(shape.name);
    if (given != parameters.end()) fixed[shape.name] = scalar_matrix(given->second);
  }
  if (objective == Objective::kMinFinalError) {
    DesignCandidate least = certify_final_error(
        theorem(), subject, fixed, weights_of_design(subject), final_error_assumptions(parameters));
    least.solver = solved.solver;
    // Where the gains leave nothing of P free, the proof is that of the design, or none.
    return least.is_verified() || !solved.is_verified() ? least : solved;
  }
  DesignCandidate candidate = certify_here(theorem(), subject, fixed, objective);
  candidate.solver = solved.solver;
  return candidate;
}

const std::vector<const DesignMethod*>& design_methods() {
  static const std::vector<const DesignMethod*> all = {
      &bernard2022_coupled_design(),
      &bernard2022_coupled_average_design(),
      &bernard2022_flow_based_design(),
      &bernard2022_flow_based_average_design(),
      &bernard2022_jump_based_design(),
      &bernard2022_jump_based_average_design(),
      &bernard2022_polytopic_design(),
      &bernard2022_metric_design(),
      &bernard2022_high_gain_design(),
      &bernard2022_high_gain_average_design(),
      &bernard2022_high_gain_lipschitz_design(),
      &bernard2022_high_gain_lipschitz_average_design(),
      &bernard2022_switched_flow_based_design(),
      &bernard2022_switched_flow_based_average_design(),
      &bernard2022_switched_jump_based_average_design(),
      &bernard2022_projection_design(),
      &bernard2022_switched_jump_based_design(),
      &bernard2022_switched_metric_design(),
      &etienne2019_proposition1_design(),
      &etienne2019_proposition2_design(),
      &ferrante2016_corollary1(),
      &ferrante2016_proposition1(),
      &ferrante2019_proposition2(),
      &ferrante2019_proposition3(),
      &ferrante2019_proposition4(),
      &ferrante2019_proposition5(),
      &ferrante2019_alternating(),
      &ferrante2019_proposition2_predictor(),
      &ferrante2019_alternating_predictor(),
      &ferrante2019_proposition3_hold(),
      &ferrante2019_proposition4_hold(),
      &ferrante2019_alternating_hold(),
      &sferlazza2019_algorithm1(),
      &sferlazza2019_equation17_design(),
      &timer_dependent_constant_gain_design(),
      &timer_dependent_scheduled_gain_design(),
      &timer_dependent_jump_gain_design(),
      &timer_dependent_switched_design(),
      &timer_dependent_alternating_gain(),
      &timer_dependent_sum_gain(),
      &timer_dependent_alternating_injection(),
      &timer_dependent_alternating_hold(),
  };
  return all;
}

const DesignMethod* find_design_method(const std::string& name) {
  const auto& all = design_methods();
  const auto found = std::find_if(
      all.begin(), all.end(), [&](const DesignMethod* method) { return method->name() == name; });
  return found == all.end() ? nullptr : *found;
}

}  // namespace sampled_data_observers
