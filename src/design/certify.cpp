#include "sampled_data_observers/design/certify.h"

#include <algorithm>
#include <limits>

namespace sampled_data_observers {
namespace {

constexpr std::size_t kTauPoints = 25;
/// By how much gamma is enlarged, so that the proof does not lie on the edge.
constexpr double kInflation = 1.001;

bool names(const std::vector<NamedShape>& shapes, const std::string& name) {
  return std::any_of(shapes.begin(), shapes.end(),
                     [&](const NamedShape& shape) { return shape.name == name; });
}

LmiProgram analysis_program(const Theorem& theorem, const CertificateSubject& subject,
                            const NamedMatrices& fixed, bool minimizes_gamma) {
  LmiProgram program;
  for (const auto& [name, value] : fixed) {
    if (!(minimizes_gamma && name == "gamma")) program.fix(name, value);
  }
  for (const NamedShape& shape : theorem.multipliers(subject)) {
    if (shape.form == NamedShape::Form::kSymmetric) {
      const MatrixExpression P = program.symmetric(shape.name, shape.rows);
      if (theorem.is_homogeneous(subject)) {
        program.bound_above(shape.name + " <= I", P, identity(shape.rows));
      }
    } else {
      program.matrix(shape.name, shape.rows, shape.cols);
    }
  }
  if (minimizes_gamma) {
    program.minimize(program.squared("gamma"));
  } else if (names(theorem.parameters(subject), "gamma") && fixed.count("gamma") == 0) {
    program.squared("gamma");
  }
  for (const Condition& condition : theorem.conditions(subject)) {
    program.require(condition, kTauPoints);
  }
  return program;
}

}  // namespace

DesignCandidate certify_here(const Theorem& theorem, const CertificateSubject& subject,
                             const NamedMatrices& fixed, Objective objective) {
  DesignCandidate candidate;
  NamedMatrices all = fixed;
  if (objective == Objective::kMinGamma && names(theorem.parameters(subject), "gamma")) {
    const LmiSolution best =
        solve_with_csdp(analysis_program(theorem, subject, fixed, true), SolverOptions());
    candidate.solver = best.solver;
    if (best.values.empty() || best.status == SolverStatus::kInfeasible) {
      candidate.message = best.message;
      return candidate;
    }
    all["gamma"] = kInflation * best.values.at("gamma");
  }
  const LmiSolution inside =
      solve_with_csdp(analysis_program(theorem, subject, all, false), SolverOptions());
  candidate.solver = inside.solver;
  if (inside.values.empty()) {
    candidate.message = inside.message;
    return candidate;
  }
  for (const auto& [name, value] : inside.values) all[name] = value;
  const std::vector<ConditionCheck> checks = check(theorem.conditions(subject), all);
  candidate.margin = std::numeric_limits<double>::infinity();
  for (const ConditionCheck& check : checks) {
    candidate.margin = std::min(candidate.margin, check.min_eigenvalue);
  }
  if (!all_hold(checks)) candidate.message = describe_violations(checks);
  candidate.cost = objective == Objective::kMinGamma && all.count("gamma") > 0
                       ? scalar_value(all, "gamma")
                       : -inside.margin;
  candidate.values = std::move(all);
  return candidate;
}

}  // namespace sampled_data_observers
