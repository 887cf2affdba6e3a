#include "design/certify.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "design/final_error.h"
#include "design/run_time_figures.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kTauPoints = 25;
constexpr int kMaxRounds = 10;
/// Of those of which only a least size matters, in the units of the attempt.
constexpr double kLargestMultiplier = 1e6;

bool names(const std::vector<NamedShape>& shapes, const std::string& name) {
  return std::any_of(shapes.begin(), shapes.end(),
                     [&](const NamedShape& shape) { return shape.name == name; });
}

/// A value of τ at which the condition of this number is demanded, too.
struct FurtherTime {
  std::size_t condition = 0;
  double tau = 0.0;
};

LmiProgram analysis_program(const Theorem& theorem, const CertificateSubject& subject,
                            const NamedMatrices& fixed, bool minimizes_gamma,
                            const std::vector<FurtherTime>& further = {},
                            bool bounds_multiples = true) {
  LmiProgram program;
  for (const auto& [name, value] : fixed) {
    if (!(minimizes_gamma && name == "gamma")) program.fix(name, value);
  }
  for (const NamedShape& shape : theorem.multipliers(subject)) {
    if (fixed.count(shape.name) > 0) continue;
    if (shape.form == NamedShape::Form::kSymmetric) {
      const MatrixExpression P = program.symmetric(shape.name, shape.rows);
      if (bounds_multiples && theorem.is_homogeneous(subject)) {
        program.bound_above(shape.name + " <= I", P, identity(shape.rows));
      }
    } else {
      program.matrix(shape.name, shape.rows, shape.cols);
    }
  }
  const std::vector<std::string> unlimited = theorem.unlimited_multipliers(subject);
  for (const NamedShape& shape : theorem.multipliers(subject)) {
    const bool is_limited =
        std::find(unlimited.begin(), unlimited.end(), shape.name) == unlimited.end();
    if (is_limited || fixed.count(shape.name) > 0) continue;
    program.bound_above(shape.name + " <= limit", symbol(shape.name, shape.rows, shape.cols),
                        MatrixExpression(kLargestMultiplier) * identity(shape.rows));
  }
  if (minimizes_gamma) {
    program.minimize(program.squared("gamma"));
  }
  const std::vector<Condition> conditions = theorem.conditions(subject);
  for (const Condition& condition : conditions) program.require(condition, kTauPoints);
  for (const FurtherTime& time : further) {
    program.require_at(conditions[time.condition], time.tau);
  }
  return program;
}

/// Looks for a proof with the multipliers of `program_for`, which is asked again with more values
/// of τ until the conditions hold at those looked at.
DesignCandidate certify_inside(
    const Theorem& theorem, const CertificateSubject& subject, NamedMatrices all,
    Objective objective, DesignCandidate candidate,
    const std::function<LmiProgram(const std::vector<FurtherTime>&)>& program_for) {
  std::vector<FurtherTime> further;
  for (int round = 0; round < kMaxRounds; ++round) {
    const LmiProgram program = program_for(further);
    bool can_improve = program.scalar_variables() > 0;
    if (can_improve) {
      const LmiSolution inside = solve_here(program, SolverOptions());
      candidate.solver = inside.solver;
      if (inside.values.empty()) {
        candidate.message = "the program of the proof " + why_unsolved(inside);
        return candidate;
      }
      for (const auto& [name, value] : inside.values) all[name] = value;
      can_improve = inside.satisfies_all();
    }
    const std::vector<ConditionCheck> checks = check(theorem.conditions(subject), all);
    // What holds at the values of τ solved for may be violated between them.
    const std::size_t before = further.size();
    for (std::size_t i = 0; i < checks.size(); ++i) {
      if (!checks[i].holds() && checks[i].tau) further.push_back({i, *checks[i].tau});
    }
    if (!can_improve || further.size() == before) break;
  }
  return judged(theorem, subject, std::move(all), objective, std::move(candidate));
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
  candidate.margin = least_margin(checks);
  candidate.message.clear();
  for (const ConditionCheck& check : checks) {
    if (check.holds()) continue;
    candidate.message += (candidate.message.empty() ? "violated: " : "; ") + check.name;
  }
  candidate.cost = objective == Objective::kMinGamma && candidate.values.count("gamma") > 0
                       ? theorem.gain_figure(candidate.values).value
                       : -candidate.margin;
  return candidate;
}

DesignCandidate certify_here(const Theorem& theorem, const CertificateSubject& subject,
                             const NamedMatrices& fixed, Objective objective) {
  DesignCandidate candidate;
  NamedMatrices all = fixed;
  const bool is_asked = objective == Objective::kMinGamma;
  if (names(theorem.parameters(subject), "gamma") && (is_asked || fixed.count("gamma") == 0)) {
    const LmiSolution best =
        solve_here(analysis_program(theorem, subject, fixed, true), SolverOptions());
    candidate.solver = best.solver;
    if (best.values.empty() || best.status == SolverStatus::kInfeasible) {
      candidate.message = "the program of the proof " + why_unsolved(best);
      return candidate;
    }
    all["gamma"] = (is_asked ? kGammaInflation : kUnaskedGammaInflation) * best.values.at("gamma");
  }
  return certify_inside(theorem, subject, all, objective, std::move(candidate),
                        [&](const std::vector<FurtherTime>& further) {
                          return analysis_program(theorem, subject, all, false, further);
                        });
}

DesignCandidate certify_final_error(const Theorem& theorem, const CertificateSubject& subject,
                                    const NamedMatrices& fixed, const Eigen::VectorXd& weights,
                                    const ErrorAssumptions& assumptions) {
  Parameters parameters = {{kNoise, assumptions.noise}, {kDisturbance, assumptions.disturbance}};
  const auto program_for = [&](const std::vector<FurtherTime>& further) {
    LmiProgram program = analysis_program(theorem, subject, fixed, false, further, false);
    if (names(theorem.parameters(subject), "gamma") && fixed.count("gamma") == 0) {
      program.squared("gamma");
    }
    minimize_final_error(program, theorem, subject, fixed, weights, parameters);
    return program;
  };
  DesignCandidate candidate;
  if (!has_final_error_level(theorem, subject)) {
    candidate = certify_here(theorem, subject, fixed, Objective::kMinGamma);
    if (candidate.is_verified()) {
      candidate.cost = final_error(theorem, subject, candidate.values, assumptions);
    }
    return candidate;
  }
  const LmiSolution least = solve_here(program_for({}), SolverOptions());
  candidate.solver = least.solver;
  if (least.values.empty() || least.status == SolverStatus::kInfeasible) {
    candidate.message = "the program of the proof " + why_unsolved(least);
    return candidate;
  }
  parameters[kFinalErrorLevel] = kFinalErrorRoom * least.values.at(kFinalErrorLevel)(0, 0);
  candidate = certify_inside(theorem, subject, fixed, Objective::kMinFinalError,
                             std::move(candidate), program_for);
  for (const char* name : {kFinalErrorLevel, "P2_level", "noise_level"}) {
    candidate.values.erase(name);
  }
  if (!candidate.is_verified()) return candidate;
  candidate.cost = final_error_of_level(theorem, subject, fixed, parameters.at(kFinalErrorLevel));
  return candidate;
}

}  // namespace sampled_data_observers
