#include "design/final_error.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "certificate/timer_dependent.h"
#include "design/run_time_figures.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kNoisePoints = 9;

/// objective <= level, which is minimized or given.
void add_level(LmiProgram& program, const MatrixExpression& objective,
               const Parameters& parameters) {
  const auto given = parameters.find(kFinalErrorLevel);
  if (given != parameters.end()) {
    program.bound_above("final error", objective, given->second);
    return;
  }
  const MatrixExpression level = program.scalar(kFinalErrorLevel);
  program.bound_above("final error", objective, level);
  program.minimize(level);
}

/// P >= W² with the weights W, and Lᵀ e^{Aᵀτ} P e^{Aτ} L <= level: what a sample's noise adds to V
/// until the next one.
void minimize_ferrante2016_level(LmiProgram& program, const CertificateSubject& subject,
                                 const Eigen::MatrixXd& L, const Eigen::VectorXd& weights,
                                 const Parameters& parameters) {
  const Eigen::Index n = subject.plant.states();
  const MatrixExpression P = symbol("P", n, n);
  program.bound_above("least P", Eigen::MatrixXd(weights.cwiseAbs2().asDiagonal()), P);
  const MatrixExpression level = program.scalar("noise_level");
  for (std::size_t i = 0; i < kNoisePoints; ++i) {
    const double tau = subject.T1 + (subject.T2 - subject.T1) * static_cast<double>(i) /
                                        static_cast<double>(kNoisePoints - 1);
    const MatrixExpression flown = Eigen::MatrixXd(exponential_of(subject.plant.A() * tau) * L);
    program.bound_above("noise", transpose(flown) * P * flown, level * identity(L.cols()));
  }
  add_level(program, level, parameters);
}

}  // namespace

double final_error_of_level(const Theorem& theorem, const CertificateSubject& subject,
                            const NamedMatrices& fixed, double level) {
  const double root = std::sqrt(level);
  if (theorem.name() != "ferrante2016_theorem1") return root;
  return root / -std::expm1(-scalar_value(fixed, "decay") * subject.T1);
}

ErrorAssumptions final_error_assumptions(const Parameters& parameters) {
  ErrorAssumptions assumptions;
  assumptions.noise = parameters.at(kNoise);
  assumptions.disturbance = parameters.at(kDisturbance);
  return assumptions;
}

SearchRange final_error_rates(const CertificateSubject& subject,
                              const ErrorAssumptions& assumptions, bool accepts_slow) {
  const bool may_be_slow = accepts_slow || assumptions.disturbance > 0.0;
  return {(may_be_slow ? 3e-4 : 0.05) / subject.T2, 3.0 / subject.T2, true};
}

SearchRange final_error_falls(bool accepts_slow) {
  return {std::exp(-6.0), accepts_slow ? 0.995 : std::exp(-0.1), false};
}

bool has_bound_for(const Certificate& certificate, const ErrorAssumptions& assumptions) {
  try {
    const auto bound =
        certificate.theorem->error_bound(certificate.subject, certificate.values, assumptions);
    // What follows the law is a function of more than the times between jumps.
    return bound && !bound->follows_law();
  } catch (const std::invalid_argument&) {
    return false;
  }
}

bool bounds_disturbances(const Theorem& theorem) {
  // The theorems of sferlazza2019, with a rate or not, are about plants without disturbance.
  const std::string name = theorem.name();
  return name != "ferrante2016_theorem1" && name.rfind("sferlazza2019", 0) != 0;
}

bool has_final_error_level(const Theorem& theorem, const CertificateSubject& subject) {
  if (theorem.name() == "timer_dependent_switched") return false;
  if (theorem.name() == "timer_dependent_synchronized") {
    // What is held between messages of a continuous output is another source of error.
    const ModeMatrices& mode = subject.plant.mode();
    return mode.C_c.rows() == 0 && mode.C_d.rows() > 0;
  }
  return theorem.name() == "ferrante2019_theorem2" || theorem.name() == "ferrante2016_theorem1" ||
         theorem.name().rfind("timer_dependent", 0) == 0;
}

void minimize_final_error(LmiProgram& program, const Theorem& theorem,
                          const CertificateSubject& subject, const NamedMatrices& fixed,
                          const Eigen::VectorXd& weights, const Parameters& parameters) {
  if (const auto function = timer_dependent_function(theorem, subject)) {
    Parameters all = parameters;
    all["lambda_t"] = scalar_value(fixed, "lambda_t");
    if (subject.falls_at_events) all["mu"] = scalar_value(fixed, "mu");
    const bool has_free_P = fixed.count("P/0") == 0;
    minimize_timer_dependent_level(
        program, function->system(),
        has_free_P ? matrices_of(*function) : std::vector<MatrixExpression>(), subject, weights,
        all);
  } else if (const auto sum = timer_dependent_sum(theorem, subject)) {
    Parameters all = parameters;
    all["lambda_t"] = scalar_value(fixed, "lambda_t");
    minimize_timer_dependent_level(program, sum->system(), {sum->P_constant()}, subject, weights,
                                   all);
  } else if (theorem.name() == "ferrante2016_theorem1") {
    minimize_ferrante2016_level(program, subject, fixed.at("L"), weights, parameters);
  } else if (theorem.name() == "ferrante2019_theorem2") {
    Parameters all = parameters;
    for (const char* name : {"delta", "lambda_t"}) all[name] = scalar_value(fixed, name);
    minimize_ferrante2019_level(program, subject, weights, all);
  }
}

std::vector<MatrixExpression> matrices_of(const TimerDependentFunction& function) {
  std::vector<MatrixExpression> all;
  for (std::size_t node = 0; node < function.grid().size(); ++node) {
    all.push_back(function.P(node));
  }
  return all;
}

void minimize_timer_dependent_level(LmiProgram& program, const ErrorSystem& system,
                                    const std::vector<MatrixExpression>& matrices,
                                    const CertificateSubject& subject,
                                    const Eigen::VectorXd& weights, const Parameters& parameters) {
  const ErrorAssumptions assumptions = final_error_assumptions(parameters);
  for (const MatrixExpression& P : matrices) {
    Eigen::MatrixXd least = Eigen::MatrixXd::Zero(system.size, system.size);
    least.topLeftCorner(system.states, system.states) = weights.cwiseAbs2().asDiagonal();
    program.bound_above("least P", least, P);
  }
  // W of the bound ends at Σ ν_i |η_i|² / (1 − μ e^{−2 λ T1_i}), and of the disturbance, before the
  // last event, at γ² |w|² / (2 λ) (1 − e^{−2 λ T2}) / (1 − μ e^{−2 λ T2}); here over |η|² or |w|².
  const double unit = assumptions.noise > 0.0 ? assumptions.noise : assumptions.disturbance;
  const auto squared = [](double x) { return x * x; };
  const double rate = 2.0 * parameters.at("lambda_t");
  const std::vector<SamplingTimes> times = times_of_timers(subject);
  MatrixExpression level = 0.0;
  for (std::size_t timer = 0; timer < system.resets.size(); ++timer) {
    const double shortest = times[timer].T1 > 0.0 ? times[timer].T1 : times[timer].T2;
    const double fall = subject.falls_at_events
                            ? 1.0 - parameters.at("mu") * std::exp(-rate * shortest)
                            : -std::expm1(-rate * shortest);
    level = level +
            squared(assumptions.noise / unit) / fall * symbol("nu/" + system.resets[timer].name);
  }
  if (system.N.cols() > 0) {
    double push = squared(assumptions.disturbance / unit) / rate;
    if (subject.falls_at_events) {
      const double left = std::exp(-rate * subject.T2);
      push *= (1.0 - left) / (1.0 - parameters.at("mu") * left);
    }
    level = level + push * square("gamma");
  }
  add_level(program, level, parameters);
}

void minimize_ferrante2019_level(LmiProgram& program, const CertificateSubject& subject,
                                 const Eigen::VectorXd& weights, const Parameters& parameters) {
  const ErrorAssumptions assumptions = final_error_assumptions(parameters);
  const double rate = 2.0 * parameters.at("lambda_t");
  const Eigen::Index n = subject.plant.states();
  const Eigen::Index m = subject.plant.C().rows();
  program.bound_above("least P1", Eigen::MatrixXd(weights.cwiseAbs2().asDiagonal()),
                      symbol("P1", n, n));
  // W of the bound ends at ω2 |η|² / (1 − e^{−2 λ T1}) + γ² |w|² / (2 λ); here over |η|² or |w|².
  const double unit = assumptions.noise > 0.0 ? assumptions.noise : assumptions.disturbance;
  const auto squared = [](double x) { return x * x; };
  const double noise_weight = squared(assumptions.noise / unit) *
                              std::exp(parameters.at("delta") * subject.T2) /
                              -std::expm1(-rate * shortest_interval(subject));
  const MatrixExpression omega = program.scalar("P2_level");
  program.bound_above("P2 <= P2_level I", symbol("P2", m, m), omega * identity(m));
  MatrixExpression level = noise_weight * omega;
  if (subject.plant.N.cols() > 0) {
    level = level + (squared(assumptions.disturbance / unit) / rate) * square("gamma");
  }
  add_level(program, level, parameters);
}

}  // namespace sampled_data_observers
