#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "design/certify.h"
#include "design/final_error.h"
#include "design/methods/methods.h"
#include "design/methods/sampled_plant.h"
#include "design/run_time_figures.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr int kMaxIterations = 40;

/// sferlazza2019, Algorithm 1: (21) at a few times τ, to which the worst one is added until it
/// holds at all; for a rate, with A + decay I. In place of the least p_M of (50), which breaks
/// solvers, the largest t with Ξ_P(τ) >= t I and P <= I.
class Algorithm1 : public DesignMethod {
 public:
  std::string name() const override { return "sferlazza2019_algorithm1"; }

  std::string summary() const override {
    return "matrix P of the time-varying gain, from inequalities at a growing set of times";
  }

  const Theorem& theorem() const override { return *find_theorem("sferlazza2019_theorem2_rate"); }

  std::vector<DesignParameter> parameters(const CertificateSubject&) const override {
    return {{"lambda", "how much of the error a sample keeps, in [0, 1)", 0.0, std::nullopt},
            {"decay", "rate of convergence from sample to sample [1/s]; 0: (21) as printed", 0.0,
             std::nullopt}};
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay,
            Objective::kMinFinalError};
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    DesignCandidate none;
    const double lambda = parameters.at("lambda");
    const double decay = parameters.at("decay");
    if (!(lambda >= 0.0 && lambda < 1.0)) {
      none.message = "lambda must be in [0, 1)";
    } else if (decay < 0.0) {
      none.message = "decay must not be negative";
    } else if (lambda * std::exp(decay * subject.T2) >= 1.0) {
      none.message = "what lambda keeps of the error falls more slowly than by decay";
    } else {
      none.message = undetectable_sampling(subject);
    }
    if (!none.message.empty()) return none;
    const NamedMatrices scalars = {{"lambda", scalar_matrix(lambda)},
                                   {"decay", scalar_matrix(decay)}};

    const std::vector<Condition> conditions = theorem().conditions(subject);
    std::vector<double> times = {subject.T1};
    if (subject.T2 > subject.T1) times.push_back(subject.T2);
    for (int iteration = 1; iteration <= kMaxIterations; ++iteration) {
      const LmiSolution solution =
          solve_here(program(conditions, subject, scalars, times), SolverOptions());
      none.solver = solution.solver;
      if (!solution.satisfies_all()) {
        none.message = "(21) for " + std::to_string(times.size()) + " times between T1 and T2 " +
                       why_unsolved(solution);
        return none;
      }
      NamedMatrices values = scalars;
      values["P"] = solution.values.at("P");
      const std::optional<double> worst = worst_time(conditions, values, times);
      if (!worst) return finished(subject, parameters, values, objective, solution, iteration);
      times.push_back(*worst);
    }
    none.message = "(21) was not proved for all times between T1 and T2 in " +
                   std::to_string(kMaxIterations) + " iterations";
    return none;
  }

 private:
  static LmiProgram program(const std::vector<Condition>& conditions,
                            const CertificateSubject& subject, const NamedMatrices& scalars,
                            const std::vector<double>& times) {
    LmiProgram program;
    const MatrixExpression P = program.symmetric("P", subject.plant.states());
    for (const auto& [name, value] : scalars) program.fix(name, value);
    program.bound_above("P <= I", P, identity(subject.plant.states()));
    for (const Condition& condition : conditions) {
      if (!condition.tau) {
        program.require(condition, 1);
        continue;
      }
      for (const double tau : times) program.require_at(condition, tau);
    }
    return program;
  }

  DesignCandidate finished(const CertificateSubject& subject, const Parameters& parameters,
                           const NamedMatrices& values, Objective objective,
                           const LmiSolution& solution, int iteration) const {
    DesignCandidate found = certify_here(theorem(), subject, values, objective);
    found.solver = solution.solver + ", in " + std::to_string(iteration) +
                   (iteration == 1 ? " iteration" : " iterations");
    if (!found.is_verified()) return found;
    if (found.margin <= kLeastMargin) {
      DesignCandidate none;
      none.solver = found.solver;
      none.message = on_the_edge(found.margin);
      return none;
    }
    if (objective == Objective::kMinFinalError) {
      found.cost =
          final_error(theorem(), subject, found.values, final_error_assumptions(parameters));
    }
    return found;
  }

  /// The time at which (21) is less than half as far inside as at those solved for (51); none where
  /// there is none.
  static std::optional<double> worst_time(const std::vector<Condition>& conditions,
                                          const NamedMatrices& values,
                                          const std::vector<double>& times) {
    std::vector<Condition> at_times;
    for (Condition condition : conditions) {
      if (!condition.tau) continue;
      for (const double tau : times) {
        condition.tau = Condition::Range{tau, tau};
        at_times.push_back(condition);
      }
    }
    std::optional<double> worst;
    double least = least_margin(check(at_times, values)) / 2.0;
    for (const ConditionCheck& check : check(conditions, values)) {
      if (!check.tau || check.margin() >= least) continue;
      least = check.margin();
      worst = check.tau;
    }
    return worst;
  }
};

/// sferlazza2019, (17): nothing is searched for.
class Equation17Design : public DesignMethod {
 public:
  std::string name() const override { return "sferlazza2019_equation17"; }
  std::string summary() const override {
    return "gain for outputs that show all of the state at once";
  }
  const Theorem& theorem() const override { return *find_theorem("sferlazza2019_equation17"); }

  std::vector<DesignParameter> parameters(const CertificateSubject&) const override {
    return {{"lambda", "how much of the error a sample keeps, in [0, 1)", 0.0, std::nullopt}};
  }
  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible};
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    DesignCandidate candidate;
    candidate.solver = "none";
    return judged(theorem(), subject, {{"lambda", scalar_matrix(parameters.at("lambda"))}},
                  objective, candidate);
  }
};

}  // namespace

const DesignMethod& sferlazza2019_equation17_design() {
  static const Equation17Design method;
  return method;
}

const DesignMethod& sferlazza2019_algorithm1() {
  static const Algorithm1 method;
  return method;
}

}  // namespace sampled_data_observers
