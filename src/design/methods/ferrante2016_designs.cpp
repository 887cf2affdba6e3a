#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "design/assumed_disturbance.h"
#include "design/certify.h"
#include "design/final_error.h"
#include "design/methods/methods.h"
#include "design/methods/sampled_plant.h"
#include "design/polytopic_embedding.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// ferrante2016 (36): with J = F L, (12) is linear in F, J and P for each value of e^{Aτ}.
class ConstantGainDesign : public LmiDesignMethod {
 public:
  const Theorem& theorem() const override { return *find_theorem("ferrante2016_theorem1"); }

  std::vector<DesignParameter> parameters(const CertificateSubject&) const override {
    return {{"decay", "rate of convergence from sample to sample [1/s]; 0: (12) as printed", 0.0,
             std::nullopt}};
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay,
            Objective::kMinFinalError};
  }

 protected:
  static std::string objection(const CertificateSubject& subject, const Parameters& parameters) {
    if (parameters.at("decay") < 0.0) return "decay must not be negative";
    return undetectable_sampling(subject);
  }

  static Eigen::MatrixXd flow(const CertificateSubject& subject, const Parameters& parameters) {
    const Eigen::Index n = subject.plant.states();
    return subject.plant.A() + parameters.at("decay") * Eigen::MatrixXd::Identity(n, n);
  }

  /// (36) with each of these in place of e^{Aτ}; for the least final error with a row for the
  /// noise, which enters through −L: V after the next interval is at most V + level |η|².
  static LmiProgram program_at(const CertificateSubject& subject, const Parameters& parameters,
                               Objective objective,
                               const std::vector<Eigen::MatrixXd>& exponentials,
                               const std::string& number) {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression C = subject.plant.C();
    LmiProgram program;
    const MatrixExpression P = program.symmetric("P", n);
    const MatrixExpression F = program.matrix("F", n, n);
    const MatrixExpression J = program.matrix("J", n, subject.plant.C().rows());
    if (objective != Objective::kMinFinalError) {
      for (const Eigen::MatrixXd& X : exponentials) {
        const MatrixExpression flown = transpose(MatrixExpression(X)) * P;
        program.require_negative(
            number, symmetric_blocks({{-He(F), F - J * C, flown}, {-P, zeros(n, n)}, {-P}}));
      }
      program.bound_above("P <= I", P, identity(n));
      return program;
    }
    const auto given = parameters.find(kFinalErrorLevel);
    const bool is_given = given != parameters.end();
    const MatrixExpression level =
        is_given ? MatrixExpression(given->second) : program.scalar(kFinalErrorLevel);
    const Eigen::Index m = subject.plant.C().rows();
    for (const Eigen::MatrixXd& X : exponentials) {
      const MatrixExpression flown = transpose(MatrixExpression(X)) * P;
      program.require_negative(number + " with noise",
                               symmetric_blocks({{-He(F), F - J * C, -J, flown},
                                                 {-P, zeros(n, m), zeros(n, n)},
                                                 {-(level * identity(m)), zeros(m, n)},
                                                 {-P}}));
    }
    const Eigen::VectorXd weights = weights_of_design(subject);
    program.bound_above("least P", Eigen::MatrixXd(weights.cwiseAbs2().asDiagonal()), P);
    if (!is_given) program.minimize(level);
    return program;
  }

  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    return {{"L", solve_linear(solution.at("F"), solution.at("J"))}};
  }
};

/// ferrante2016, Corollary 1: the vertices of a polytope around e^{Aτ} are enough. P of the
/// solution is the proof for all τ.
class Corollary1 : public ConstantGainDesign {
 public:
  std::string name() const override { return "ferrante2016_corollary1"; }

  std::string summary() const override {
    return "constant gain L, by a polytope around e^(A tau); up to 2^n inequalities";
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    DesignCandidate none;
    none.message = objection(subject, parameters);
    if (!none.message.empty()) return none;
    if (objective == Objective::kMinFinalError) {
      return LmiDesignMethod::attempt(subject, parameters, objective);
    }
    DesignCandidate candidate = solve(subject, parameters, objective);
    if (!candidate.is_verified() || candidate.margin > kLeastMargin) return candidate;
    none.message = on_the_edge(candidate.margin);
    return none;
  }

  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective objective) const override {
    return program_at(subject, parameters, objective,
                      polytopic_embedding(flow(subject, parameters), subject.T1, subject.T2),
                      "(41)");
  }
};

/// ferrante2016, Proposition 1: (36) is equivalent to (12), so that a few times τ, to which the
/// worst one is added until (12) holds at all, lose nothing that a polytope would. Those that
/// others imply in the end cost time only.
class Proposition1 : public ConstantGainDesign {
 public:
  std::string name() const override { return "ferrante2016_proposition1"; }

  std::string summary() const override {
    return "constant gain L, from inequalities at a growing set of times";
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    DesignCandidate none;
    none.message = objection(subject, parameters);
    if (!none.message.empty()) return none;
    const std::vector<Condition> conditions = theorem().conditions(subject);
    std::vector<double> times = first_times(subject);
    for (int iteration = 1; iteration <= kMaxIterations; ++iteration) {
      const LmiSolution solution = solved_at_times(subject, parameters, objective, times);
      none.solver = solution.solver;
      if (!solution.satisfies_all()) {
        none.message = "(36) for " + std::to_string(times.size()) + " times between T1 and T2 " +
                       why_unsolved(solution);
        return none;
      }
      NamedMatrices values = gains(subject, parameters, solution.values);
      values["P"] = solution.values.at("P");
      values["decay"] = scalar_matrix(parameters.at("decay"));
      const std::optional<double> worst = violated_time(conditions, values);
      if (!worst && objective == Objective::kMinFinalError) {
        values.erase("P");
        return certify_final_error(theorem(), subject, values, weights_of_design(subject),
                                   final_error_assumptions(parameters));
      }
      if (!worst) return finished(subject, std::move(values), objective, solution, iteration);
      times.push_back(*worst);
    }
    none.message = "(12) does not hold for all times between T1 and T2 after " +
                   std::to_string(kMaxIterations) + " iterations";
    return none;
  }

  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective objective) const override {
    return program_at_times(subject, parameters, objective, first_times(subject));
  }

 private:
  static constexpr int kMaxIterations = 40;
  static constexpr int kFirstTimes = 9;

  static std::vector<double> first_times(const CertificateSubject& subject) {
    if (subject.T1 == subject.T2) return {subject.T1};
    std::vector<double> times;
    for (int i = 0; i < kFirstTimes; ++i) {
      times.push_back(subject.T1 + (subject.T2 - subject.T1) * i / (kFirstTimes - 1));
    }
    return times;
  }

  static LmiProgram program_at_times(const CertificateSubject& subject,
                                     const Parameters& parameters, Objective objective,
                                     const std::vector<double>& times) {
    const Eigen::MatrixXd A = flow(subject, parameters);
    std::vector<Eigen::MatrixXd> exponentials;
    for (const double tau : times) exponentials.push_back(exponential_of(A * tau));
    return program_at(subject, parameters, objective, exponentials, "(36)");
  }

  /// Of a least level, the solution for a slightly larger one: gains at the edge can't be proved.
  static LmiSolution solved_at_times(const CertificateSubject& subject,
                                     const Parameters& parameters, Objective objective,
                                     const std::vector<double>& times) {
    LmiSolution solution =
        solve_here(program_at_times(subject, parameters, objective, times), SolverOptions());
    const auto level = solution.values.find(kFinalErrorLevel);
    if (level == solution.values.end()) return solution;
    Parameters with_room = parameters;
    with_room[kFinalErrorLevel] = kFinalErrorRoom * level->second(0, 0);
    return solve_here(program_at_times(subject, with_room, objective, times), SolverOptions());
  }

  /// Where (12) holds least, if it does not hold there by the margin that a design needs.
  static std::optional<double> violated_time(const std::vector<Condition>& conditions,
                                             const NamedMatrices& values) {
    std::optional<double> worst;
    double least = kLeastMargin;
    for (const ConditionCheck& check : check(conditions, values)) {
      if (!check.tau || check.min_eigenvalue > least) continue;
      least = check.min_eigenvalue;
      worst = check.tau;
    }
    return worst;
  }

  DesignCandidate finished(const CertificateSubject& subject, NamedMatrices values,
                           Objective objective, const LmiSolution& solution, int iteration) const {
    DesignCandidate found = judged(theorem(), subject, std::move(values), objective, {});
    found.solver = solution.solver + ", in " + std::to_string(iteration) +
                   (iteration == 1 ? " iteration" : " iterations");
    return found;
  }
};

}  // namespace

const DesignMethod& ferrante2016_corollary1() {
  static const Corollary1 method;
  return method;
}

const DesignMethod& ferrante2016_proposition1() {
  static const Proposition1 method;
  return method;
}

}  // namespace sampled_data_observers
