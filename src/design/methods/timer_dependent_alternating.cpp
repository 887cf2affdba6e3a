#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "certificate/timer_dependent.h"
#include "design/assumed_disturbance.h"
#include "design/certify.h"
#include "design/final_error.h"
#include "design/methods/ferrante2019.h"
#include "design/methods/gain_bound.h"
#include "design/methods/methods.h"
#include "design/methods/timer_dependent.h"
#include "design/methods/timer_dependent_start.h"
#include "design/methods/timer_dependent_sum_start.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Gains in which the conditions are linear where P is fixed, as they are linear in P where the
/// gains are: from gains of another design, the two are improved in turn.
class AlternatingDesign : public DesignMethod {
 public:
  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return timer_dependent_parameters(subject);
  }
  std::vector<Objective> objectives(const CertificateSubject& subject) const override {
    return timer_dependent_objectives(subject);
  }

  DesignCandidate attempt(const CertificateSubject& given, const Parameters& parameters,
                          Objective objective) const override {
    const CertificateSubject subject = timer_dependent_subject(given, parameters, objective);
    DesignCandidate best;
    const auto offer = [&](const NamedMatrices& gains) {
      DesignCandidate start = with_best_P(subject, parameters, objective, gains);
      if (best.values.empty() || is_better(start, best)) best = std::move(start);
    };
    const std::vector<NamedMatrices> all = starts(subject, parameters, objective);
    for (const NamedMatrices& gains : all) offer(gains);
    if (!best.is_verified() && !all.empty()) {
      CertificateSubject undisturbed = subject;
      undisturbed.plant.N.resize(subject.plant.states(), 0);
      const auto gains =
          gains_of_rate(theorem(), undisturbed, all.front(), parameters.at("lambda_t"));
      if (gains) offer(*gains);
    }
    for (int step = 0; step < kMaxSteps && !best.values.empty(); ++step) {
      const NamedMatrices gains = better_gains(subject, parameters, objective, best.values);
      if (gains.empty()) break;
      DesignCandidate next = with_best_P(subject, parameters, objective, gains);
      if (!is_better(next, best)) break;
      const double progress = best.cost - next.cost;
      const bool was_verified = best.is_verified();
      best = std::move(next);
      if (was_verified && progress < kLeastProgress * std::abs(best.cost)) break;
    }
    if (best.values.empty() && best.message.empty()) best.message = "no gains to begin with";
    if (subject.plant.N.cols() == given.plant.N.cols() || !best.is_verified()) return best;
    return certify_here(theorem(), given, fixed_by(given, parameters, objective, best.values),
                        objective);
  }

 protected:
  /// Gains to begin with, by the theorem's names, the best first or not.
  virtual std::vector<NamedMatrices> starts(const CertificateSubject& subject,
                                            const Parameters& parameters,
                                            Objective objective) const = 0;

 private:
  NamedMatrices fixed_by(const CertificateSubject& subject, const Parameters& parameters,
                         Objective objective, const NamedMatrices& gains) const {
    NamedMatrices fixed;
    for (const NamedShape& shape : theorem().gains(subject)) {
      fixed[shape.name] = gains.at(shape.name);
    }
    fixed["lambda_t"] = scalar_matrix(parameters.at("lambda_t"));
    if (subject.falls_at_events) fixed["mu"] = scalar_matrix(parameters.at("mu"));
    const auto gamma = parameters.find("gamma");
    if (gamma != parameters.end() && objective != Objective::kMinGamma) {
      fixed["gamma"] = scalar_matrix(gamma->second);
    }
    return fixed;
  }

  DesignCandidate with_best_P(const CertificateSubject& subject, const Parameters& parameters,
                              Objective objective, const NamedMatrices& gains) const {
    const NamedMatrices fixed = fixed_by(subject, parameters, objective, gains);
    if (objective != Objective::kMinFinalError) {
      return certify_here(theorem(), subject, fixed, objective);
    }
    return certify_final_error(theorem(), subject, fixed, weights_of_design(subject),
                               final_error_assumptions(parameters));
  }

  /// The gains that are best for the matrices P of a design; none where the solver finds none.
  NamedMatrices better_gains(const CertificateSubject& subject, const Parameters& parameters,
                             Objective objective, const NamedMatrices& values) const {
    Parameters with_room = parameters;
    LmiSolution solution =
        solve_here(gain_program(subject, parameters, objective, values), SolverOptions());
    Objective inside = objective;
    if (objective == Objective::kMinGamma && !solution.values.empty()) {
      with_room["gamma"] = kRoom * scalar_value(solution.values, "gamma");
      inside = Objective::kFeasible;
    }
    const auto level = solution.values.find(kFinalErrorLevel);
    if (level != solution.values.end()) {
      with_room[kFinalErrorLevel] = kRoom * level->second(0, 0);
    }
    if (with_room.size() > parameters.size() || inside != objective) {
      solution = solve_here(gain_program(subject, with_room, inside, values), SolverOptions());
    }
    NamedMatrices gains;
    for (const NamedShape& shape : theorem().gains(subject)) {
      const auto found = solution.values.find(shape.name);
      if (found == solution.values.end() || !found->second.allFinite()) return {};
      gains[shape.name] = found->second;
    }
    return gains;
  }

  LmiProgram gain_program(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective, const NamedMatrices& values) const {
    LmiProgram program;
    const std::vector<std::string> bounded = bounded_gains(subject);
    for (const NamedShape& shape : theorem().gains(subject)) {
      const MatrixExpression gain = program.matrix(shape.name, shape.rows, shape.cols);
      if (std::find(bounded.begin(), bounded.end(), shape.name) == bounded.end()) continue;
      bound_norm(program, shape.name, gain, parameters.at("gain_bound"));
    }
    for (const NamedShape& shape : theorem().multipliers(subject)) {
      if (shape.form == NamedShape::Form::kScalar) {
        program.bound_above(shape.name, program.scalar(shape.name), kLargest);
      } else if (shape.name.rfind("jump_part", 0) == 0) {
        program.symmetric(shape.name, shape.rows);
      } else {
        program.fix(shape.name, values.at(shape.name));
      }
    }
    program.fix("lambda_t", scalar_matrix(parameters.at("lambda_t")));
    if (subject.falls_at_events) program.fix("mu", scalar_matrix(parameters.at("mu")));
    add_gamma(program, subject, parameters, objective);
    for (const Condition& condition : theorem().conditions(subject)) program.require(condition, 1);
    if (objective == Objective::kMinFinalError) {
      minimize_timer_dependent_level(program, error_system(subject), {}, subject,
                                     weights_of_design(subject), parameters);
    }
    return program;
  }

  ErrorSystem error_system(const CertificateSubject& subject) const {
    const auto function = timer_dependent_function(theorem(), subject);
    return function ? function->system() : timer_dependent_sum(theorem(), subject)->system();
  }

  /// Of noise levels, in the units of the attempt.
  static constexpr double kLargest = 1e6;
  static constexpr int kMaxSteps = 30;
  /// A step that gains less ends the alternation.
  static constexpr double kLeastProgress = 1e-3;
  /// Gains are sought for a gamma or a level larger than the least one, so that they are not at the
  /// edge, where the next Lyapunov matrices could not move.
  static constexpr double kRoom = 1.01;
};

/// Constant gains of several sensors.
class AlternatingJumpGains : public AlternatingDesign {
 public:
  std::string name() const override { return "timer_dependent_alternating_gain"; }
  std::string summary() const override {
    return "constant gains L of several sensors, from the means of timer_dependent_scheduled_gain, "
           "improved by alternating between gains and Lyapunov matrices";
  }
  const Theorem& theorem() const override { return *find_theorem("timer_dependent_constant_gain"); }

  void require_applicable(const CertificateSubject& subject) const override {
    require_subject(theorem(), subject);
    if (subject.plant.sampled.size() > 1) return;
    throw std::invalid_argument(
        "it is about several sensors; timer_dependent_constant_gain is about one");
  }

 protected:
  std::vector<NamedMatrices> starts(const CertificateSubject& subject, const Parameters& parameters,
                                    Objective objective) const override {
    const DesignMethod& scheduled = timer_dependent_scheduled_gain_design();
    const DesignCandidate found = scheduled.attempt(subject, parameters, objective);
    if (found.values.empty()) return {};
    NamedMatrices means;
    const std::size_t nodes = grid_of(subject).size();
    for (std::size_t i = 0; i < subject.plant.sampled.size(); ++i) {
      const std::string of_sensor = "K/" + subject.plant.sampled[i].sensor + "/";
      Eigen::MatrixXd sum =
          Eigen::MatrixXd::Zero(subject.plant.states(), subject.plant.sampled[i].rows);
      for (std::size_t node = 0; node < nodes; ++node) {
        sum += found.values.at(of_sensor + std::to_string(node));
      }
      means[gain_of_sensor("L", subject, i)] = sum / static_cast<double>(nodes);
    }
    return {means};
  }
};

/// Constant gains of any number of sensors.
class AlternatingGainsOfSum : public AlternatingDesign {
 public:
  std::string name() const override { return "timer_dependent_sum_gain"; }
  std::string summary() const override {
    return "constant gains L of any number of sensors, by a sum of functions of one timer each, "
           "improved by alternating between gains and Lyapunov matrices";
  }
  const Theorem& theorem() const override {
    return *find_theorem("timer_dependent_sum_constant_gain");
  }

 protected:
  std::vector<NamedMatrices> starts(const CertificateSubject& subject, const Parameters& parameters,
                                    Objective objective) const override {
    const NamedMatrices gains = gains_for_constant_products(subject, parameters, objective);
    return gains.empty() ? std::vector<NamedMatrices>() : std::vector<NamedMatrices>{gains};
  }
};

/// Gains L and H of an intersample injection, or L of a held one.
class AlternatingInjection : public AlternatingDesign {
 public:
  explicit AlternatingInjection(bool is_held) : is_held_(is_held) {}

  std::string name() const override {
    return is_held_ ? "timer_dependent_alternating_hold" : "timer_dependent_alternating_injection";
  }
  std::string summary() const override {
    return is_held_ ? "gain L of a held innovation, by alternation from gains of ferrante2019"
                    : "gains L and H of an intersample injection, by alternation from gains of "
                      "ferrante2019";
  }
  const Theorem& theorem() const override {
    return *find_theorem(is_held_ ? "timer_dependent_sample_and_hold"
                                  : "timer_dependent_intersample_injection");
  }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    std::vector<DesignParameter> all = AlternatingDesign::parameters(subject);
    all.push_back({"gain_bound", "bound on the norm of L", 1000.0, std::nullopt});
    return all;
  }
  std::vector<std::string> bounded_gains(const CertificateSubject&) const override { return {"L"}; }

  void require_applicable(const CertificateSubject& subject) const override {
    require_subject(theorem(), subject);
    if (subject.plant.sampled.size() == 1) return;
    throw std::invalid_argument("it is about one sensor, as the gains are that it begins with");
  }

 protected:
  std::vector<NamedMatrices> starts(const CertificateSubject& subject, const Parameters& parameters,
                                    Objective objective) const override {
    std::vector<NamedMatrices> all;
    Parameters own = parameters;
    own["a"] = 0.25 / subject.T2;
    for (const double delta : {1.0, 4.0, 12.0}) {
      own["delta"] = delta / subject.T2;
      for (const DesignMethod* method : methods()) {
        DesignCandidate found = method->attempt(subject, own, objective);
        if (found.values.empty()) continue;
        NamedMatrices gains = {{"L", found.values.at("L")}};
        if (is_held_) {
          gains["L"] = -gains["L"];
        } else {
          gains["H"] = found.values.at("H");
        }
        all.push_back(std::move(gains));
      }
    }
    return all;
  }

 private:
  std::vector<const DesignMethod*> methods() const {
    if (is_held_) return {&ferrante2019_proposition4_hold()};
    return {&ferrante2019_proposition2(), &ferrante2019_proposition4()};
  }

  bool is_held_;
};

}  // namespace

const DesignMethod& timer_dependent_alternating_gain() {
  static const AlternatingJumpGains method;
  return method;
}

const DesignMethod& timer_dependent_sum_gain() {
  static const AlternatingGainsOfSum method;
  return method;
}

const DesignMethod& timer_dependent_alternating_injection() {
  static const AlternatingInjection method(false);
  return method;
}

const DesignMethod& timer_dependent_alternating_hold() {
  static const AlternatingInjection method(true);
  return method;
}

}  // namespace sampled_data_observers
