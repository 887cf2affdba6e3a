#include <utility>

#include "certificate/bernard2022.h"
#include "certificate/theorems.h"
#include "design/certify.h"
#include "design/methods/bernard2022_parameters.h"
#include "design/methods/methods.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kFirstTimes = 5;
constexpr int kMostRounds = 20;

/// The metrics of gains L(τ): as the gain is eliminated, the conditions are linear in them at each
/// τ. They are asked for at a few, to which those are added at which they do not hold, as in
/// Algorithm 1 of sferlazza2019.
class MetricDesign : public DesignMethod {
 public:
  MetricDesign(std::string summary, const Theorem& theorem)
      : summary_(std::move(summary)), theorem_(theorem) {}

  std::string name() const override { return theorem_.name(); }
  std::string summary() const override { return summary_; }
  const Theorem& theorem() const override { return theorem_; }

  std::vector<DesignParameter> parameters(const CertificateSubject&) const override {
    return {jump_decay_parameter()};
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay};
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    const std::vector<Condition> conditions = theorem_.conditions(subject);
    const NamedMatrices scalars = {{"jump_decay", scalar_matrix(parameters.at("jump_decay"))}};
    std::vector<std::vector<double>> times(conditions.size());
    DesignCandidate none;
    for (int round = 0; round < kMostRounds; ++round) {
      const LmiSolution solution =
          solve_here(program(subject, conditions, scalars, times), SolverOptions());
      none.solver = solution.solver;
      if (!solution.satisfies_all()) {
        none.message = "the program of the metrics " + why_unsolved(solution);
        return none;
      }
      NamedMatrices values = scalars;
      for (const NamedShape& shape : theorem_.gains(subject)) {
        values[shape.name] = solution.values.at(shape.name);
      }
      const std::vector<ConditionCheck> checks = check(conditions, values);
      bool can_improve = false;
      for (std::size_t i = 0; i < checks.size(); ++i) {
        if (checks[i].holds() || !checks[i].tau || !is_solved_for(conditions[i])) continue;
        times[i].push_back(*checks[i].tau);
        can_improve = true;
      }
      if (!can_improve) return judged(theorem_, subject, values, objective, none);
    }
    none.message = "no metrics were found for all times between T1 and T2 in " +
                   std::to_string(kMostRounds) + " rounds";
    return none;
  }

  void restore(const CertificateSubject& subject, NamedMatrices& values) const override {
    for (const NamedShape& shape : theorem_.gains(subject)) {
      Eigen::MatrixXd& metric = values.at(shape.name);
      metric = ((metric + metric.transpose()) / 2.0).eval();
    }
  }

 private:
  static bool is_solved_for(const Condition& condition) {
    return condition.name.rfind(kIndependentOutputs, 0) != 0;
  }

  LmiProgram program(const CertificateSubject& subject, const std::vector<Condition>& conditions,
                     const NamedMatrices& scalars,
                     const std::vector<std::vector<double>>& times) const {
    LmiProgram program;
    for (const auto& [name, value] : scalars) program.fix(name, value);
    for (const NamedShape& shape : theorem_.gains(subject)) {
      const MatrixExpression P = program.symmetric(shape.name, shape.rows);
      program.bound_above("P <= I", P, identity(shape.rows));
    }
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      if (!is_solved_for(conditions[i])) continue;
      program.require(conditions[i], kFirstTimes);
      for (const double tau : times[i]) program.require_at(conditions[i], tau);
    }
    return program;
  }

  std::string summary_;
  const Theorem& theorem_;
};

}  // namespace

const DesignMethod& bernard2022_metric_design() {
  static const MetricDesign method(
      "metric of a jump-based gain L_d(tau) that knows the time since the last jump",
      bernard2022_corollary5_2_metric());
  return method;
}

const DesignMethod& bernard2022_switched_metric_design() {
  static const MetricDesign method(
      "metrics of jump-based gains L_d(tau) of a switched plant whose every switch changes the "
      "mode",
      bernard2022_section7_3_2_metric());
  return method;
}

}  // namespace sampled_data_observers
