#include "sampled_data_observers/design/certify.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sampled_data_observers {
namespace {

constexpr std::size_t kTauPoints = 25;

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

DesignCandidate judged(const Theorem& theorem, const CertificateSubject& subject,
                       NamedMatrices values, Objective objective, DesignCandidate candidate) {
  candidate.values = std::move(values);
  for (const auto& shapes :
       {theorem.gains(subject), theorem.multipliers(subject), theorem.parameters(subject)}) {
    for (const NamedShape& shape : shapes) {
      if (candidate.values.count(shape.name) > 0) continue;
      candidate.message = "no value for " + shape.name;
      return candidate;
    }
  }
  const std::vector<ConditionCheck> checks = check(theorem.conditions(subject), candidate.values);
  candidate.margin = std::numeric_limits<double>::infinity();
  candidate.message.clear();
  for (const ConditionCheck& check : checks) {
    candidate.margin = std::min(candidate.margin, check.min_eigenvalue);
    if (check.holds()) continue;
    candidate.message += (candidate.message.empty() ? "violated: " : "; ") + check.name;
  }
  candidate.cost = objective == Objective::kMinGamma && candidate.values.count("gamma") > 0
                       ? scalar_value(candidate.values, "gamma")
                       : -candidate.margin;
  return candidate;
}

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
    all["gamma"] = kGammaInflation * best.values.at("gamma");
  }
  const LmiSolution inside =
      solve_with_csdp(analysis_program(theorem, subject, all, false), SolverOptions());
  candidate.solver = inside.solver;
  if (inside.values.empty()) {
    candidate.message = inside.message;
    return candidate;
  }
  for (const auto& [name, value] : inside.values) all[name] = value;
  return judged(theorem, subject, std::move(all), objective, std::move(candidate));
}

}  // namespace sampled_data_observers
