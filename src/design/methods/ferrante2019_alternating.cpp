#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "certificate/ferrante2019_matrix.h"
#include "design/certify.h"
#include "design/methods/ferrante2019.h"
#include "design/methods/gain_bound.h"
#include "design/methods/methods.h"

namespace sampled_data_observers {
namespace {

constexpr int kMaxSteps = 30;
/// A step that gains less ends the alternation.
constexpr double kLeastProgress = 2e-4;
/// Gains are sought for a gamma larger than the least one, so that they are not at the edge, where
/// the next Lyapunov matrices could not move.
constexpr double kRoom = 1.01;

/// Beyond the paper: from the best design of Propositions 2 to 5, gains and Lyapunov matrices are
/// improved in turn, each with the other fixed, since Theorem 2 is linear in either.
class Alternating : public DesignMethod {
 public:
  Alternating(Injection injection, std::string name, std::string summary)
      : injection_(injection), name_(std::move(name)), summary_(std::move(summary)) {}

  std::string name() const override { return name_; }
  std::string summary() const override { return summary_; }
  bool is_special_case() const override { return injection_ != Injection::kFree; }

  void restore(const CertificateSubject& subject, NamedMatrices& values) const override {
    if (injection_ != Injection::kPredictor) return;
    values["H"] = -(subject.plant.C() * values.at("L"));
  }

  const Theorem& theorem() const override { return *find_theorem("ferrante2019_theorem2"); }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return ferrante2019_parameters(subject);
  }
  std::vector<std::string> bounded_gains(const CertificateSubject&) const override { return {"L"}; }
  std::vector<Objective> objectives(const CertificateSubject& subject) const override {
    std::vector<Objective> all = ferrante2019_objectives(subject);
    all.erase(std::remove(all.begin(), all.end(), Objective::kMinFinalError), all.end());
    return all;
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    DesignCandidate best = best_start(subject, parameters, objective);
    for (int step = 0; step < kMaxSteps && !best.values.empty(); ++step) {
      DesignCandidate next = improved(subject, parameters, objective, best.values);
      if (!is_better(next, best)) break;
      const double progress = best.cost - next.cost;
      const bool was_verified = best.is_verified();
      best = std::move(next);
      if (was_verified && progress < kLeastProgress * std::abs(best.cost)) break;
    }
    return best;
  }

 private:
  /// The best of the propositions, and of Proposition 2 with gains that are too large at first: its
  /// bound on them is far from tight.
  DesignCandidate best_start(const CertificateSubject& subject, const Parameters& parameters,
                             Objective objective) const {
    DesignCandidate best;
    const auto offer = [&best](DesignCandidate candidate) {
      if (best.values.empty() || is_better(candidate, best)) best = std::move(candidate);
    };
    Parameters own = parameters;
    own["a"] = 0.25 / subject.T2;
    for (const DesignMethod* method : starts(own.at("delta") > 2.0 * own.at("lambda_t"))) {
      offer(method->attempt(subject, own, objective));
    }
    if (injection_ == Injection::kHold) return best;
    const DesignMethod& second = injection_ == Injection::kFree
                                     ? ferrante2019_proposition2()
                                     : ferrante2019_proposition2_predictor();
    for (const double factor : {3.0, 10.0, 30.0}) {
      own["gain_bound"] = factor * parameters.at("gain_bound");
      const DesignCandidate large = second.attempt(subject, own, objective);
      if (!large.values.empty()) offer(improved(subject, parameters, objective, large.values));
    }
    return best;
  }

  /// The propositions that know such an injection.
  /// @param has_large_delta  what Propositions 3 and 5 ask for
  std::vector<const DesignMethod*> starts(bool has_large_delta) const {
    std::vector<const DesignMethod*> methods;
    switch (injection_) {
      case Injection::kFree:
        methods = {&ferrante2019_proposition2(), &ferrante2019_proposition4()};
        if (has_large_delta) {
          methods.push_back(&ferrante2019_proposition3());
          methods.push_back(&ferrante2019_proposition5());
        }
        break;
      case Injection::kPredictor:
        methods = {&ferrante2019_proposition2_predictor()};
        break;
      case Injection::kHold:
        methods = {&ferrante2019_proposition4_hold()};
        if (has_large_delta) {
          methods.push_back(&ferrante2019_proposition3_hold());
          methods.push_back(&ferrante2019_proposition5());
        }
        break;
    }
    return methods;
  }

  /// The design with the best gains for the Lyapunov matrices of another one, and then the best
  /// Lyapunov matrices for them.
  DesignCandidate improved(const CertificateSubject& subject, const Parameters& parameters,
                           Objective objective, const NamedMatrices& values) const {
    NamedMatrices fixed = better_gains(subject, parameters, objective, values);
    if (fixed.empty()) return {};
    for (const char* name : {"delta", "lambda_t", "gamma"}) {
      const auto given = parameters.find(name);
      if (given != parameters.end()) fixed[name] = scalar_matrix(given->second);
    }
    return certify_here(theorem(), subject, fixed, objective);
  }

  /// L and H for the Lyapunov matrices of a design; none where the solver finds none.
  NamedMatrices better_gains(const CertificateSubject& subject, const Parameters& parameters,
                             Objective objective, const NamedMatrices& values) const {
    LmiSolution solution =
        solve_here(gain_program(subject, parameters, objective, values), SolverOptions());
    if (objective == Objective::kMinGamma && !solution.values.empty()) {
      Parameters with_room = parameters;
      with_room["gamma"] = kRoom * scalar_value(solution.values, "gamma");
      solution = solve_here(gain_program(subject, with_room, Objective::kFeasible, values),
                            SolverOptions());
    }
    const bool is_of_use =
        !solution.values.empty() && keeps_gain_bound(solution.values.at("L"), parameters);
    if (!is_of_use) return {};
    const Eigen::MatrixXd& L = solution.values.at("L");
    switch (injection_) {
      case Injection::kPredictor:
        return {{"L", L}, {"H", -(subject.plant.C() * L)}};
      case Injection::kHold:
        return {{"L", L}, {"H", Eigen::MatrixXd::Zero(L.cols(), L.cols())}};
      case Injection::kFree:
        break;
    }
    return {{"L", L}, {"H", solution.values.at("H")}};
  }

  LmiProgram gain_program(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective, const NamedMatrices& values) const {
    const PlantMatrices& plant = subject.plant;
    const Eigen::Index n = plant.states();
    const Eigen::Index m = plant.C().rows();
    LmiProgram program;
    for (const char* name : {"P1", "P2", "delta", "lambda_t"}) program.fix(name, values.at(name));
    const MatrixExpression L = program.matrix("L", n, m);
    // C L + H
    MatrixExpression F22 = zeros(m, m);
    if (injection_ != Injection::kPredictor) F22 = MatrixExpression(plant.C()) * L;
    if (injection_ == Injection::kFree) F22 = F22 + program.matrix("H", m, m);
    if (!plant.is_linear()) program.require_positive("chi > 0", program.scalar("chi"));
    // What is neither asked for nor given stays as it was.
    Parameters with_gamma = parameters;
    if (values.count("gamma") > 0) with_gamma.insert({"gamma", scalar_value(values, "gamma")});
    add_gamma(program, subject, with_gamma, objective);
    const MatrixExpression P1_L = symbol("P1", n, n) * L;
    const MatrixExpression P2_CL_H = symbol("P2", m, m) * F22;
    const MatrixExpression lambda_t = symbol("lambda_t");
    const double e = std::exp(parameters.at("delta") * subject.T2);
    program.require_negative("M(0)", ferrante2019_M(plant, 1.0, lambda_t, P1_L, P2_CL_H));
    program.require_negative("M(T2)", ferrante2019_M(plant, e, lambda_t, P1_L, P2_CL_H));
    bound_norm(program, "L", L, parameters.at("gain_bound"));
    return program;
  }

  Injection injection_;
  std::string name_;
  std::string summary_;
};

}  // namespace

const DesignMethod& ferrante2019_alternating() {
  static const Alternating method(
      Injection::kFree, "ferrante2019_alternating",
      "the best of Propositions 2 to 5, improved by alternating between gains and Lyapunov "
      "matrices");
  return method;
}

const DesignMethod& ferrante2019_alternating_predictor() {
  static const Alternating method(
      Injection::kPredictor, "ferrante2019_alternating_predictor",
      "gain L of a predictor, H = -C L, improved as by ferrante2019_alternating");
  return method;
}

const DesignMethod& ferrante2019_alternating_hold() {
  static const Alternating method(Injection::kHold, "ferrante2019_alternating_hold",
                                  "gain L for a held innovation, H = 0, improved as by "
                                  "ferrante2019_alternating");
  return method;
}

}  // namespace sampled_data_observers
