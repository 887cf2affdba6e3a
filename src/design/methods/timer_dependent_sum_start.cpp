#include "design/methods/timer_dependent_sum_start.h"

#include <string>

#include "certificate/timer_dependent.h"
#include "design/assumed_disturbance.h"
#include "design/final_error.h"
#include "design/methods/ferrante2019.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Of noise levels, in the units of the attempt.
constexpr double kLargestLevelOfSum = 1e6;

/// Y_i = P⁺ K_i of a timer.
MatrixExpression product_of(const ErrorReset& reset) {
  return symbol("Y/" + reset.name, reset.C.cols(), reset.C.rows());
}

/// With Y_i constant, V − V⁺ = eᵀ (P_i(τ_i) − P_i(0)) e + 2 uᵀ Y_iᵀ e − uᵀ Y_iᵀ P⁺⁻¹ Y_i u,
/// u = C_i e + η_i, and P⁺ >= P_c + P_i(0): the other timers do not show.
MatrixExpression jump_of_constant_product(const TimerDependentSum& sum, std::size_t timer,
                                          std::size_t node) {
  const ErrorReset& reset = sum.system().resets[timer];
  const MatrixExpression Y = product_of(reset);
  const MatrixExpression C = reset.C;
  return symmetric_blocks({{sum.P(timer, node) - sum.P(timer, 0) + He(Y * C), Y, transpose(Y * C)},
                           {symbol("nu/" + reset.name) * identity(reset.C.rows()), transpose(Y)},
                           {sum.P_constant() + sum.P(timer, 0)}});
}

LmiProgram program_of(const TimerDependentSum& sum, const CertificateSubject& subject,
                      const Parameters& parameters, Objective objective) {
  LmiProgram program;
  const bool is_homogeneous = subject.plant.N.cols() == 0 && objective != Objective::kMinFinalError;
  for (const NamedShape& shape : sum.shapes()) {
    if (shape.form == NamedShape::Form::kScalar) {
      program.require_positive(shape.name, program.scalar(shape.name));
      program.bound_above(shape.name, symbol(shape.name), kLargestLevelOfSum);
    } else if (shape.name.rfind("P/", 0) == 0 || shape.name == "P_constant") {
      const MatrixExpression P = program.symmetric(shape.name, shape.rows);
      if (is_homogeneous) program.bound_above(shape.name, P, identity(shape.rows));
    } else if (shape.name.rfind("flow_part", 0) == 0) {
      program.symmetric(shape.name, shape.rows);
    }
  }
  program.fix("lambda_t", scalar_matrix(parameters.at("lambda_t")));
  add_gamma(program, subject, parameters, objective);
  for (const Condition& condition : sum.flow_conditions()) program.require(condition, 1);
  for (std::size_t timer = 0; timer < sum.timers(); ++timer) {
    const ErrorReset& reset = sum.system().resets[timer];
    program.matrix("Y/" + reset.name, reset.C.cols(), reset.C.rows());
    for (std::size_t node = 0; node < sum.nodes(timer).size(); ++node) {
      if (sum.nodes(timer)[node] < sum.shortest(timer)) continue;
      program.require_positive("jump of " + reset.name, jump_of_constant_product(sum, timer, node));
    }
  }
  if (objective == Objective::kMinFinalError) {
    minimize_timer_dependent_level(program, sum.system(), {sum.P_constant()}, subject,
                                   weights_of_design(subject), parameters);
  }
  return program;
}

}  // namespace

NamedMatrices gains_for_constant_products(const CertificateSubject& subject,
                                          const Parameters& parameters, Objective objective) {
  const TimerDependentSum sum =
      *timer_dependent_sum(*find_theorem("timer_dependent_sum_constant_gain"), subject);
  Parameters own = parameters;
  LmiSolution solution = solve_here(program_of(sum, subject, own, objective), SolverOptions());
  if (objective == Objective::kMinGamma && !solution.values.empty()) {
    own["gamma"] = 1.05 * scalar_value(solution.values, "gamma");
    solution = solve_here(program_of(sum, subject, own, Objective::kFeasible), SolverOptions());
  }
  if (solution.values.empty()) return {};
  const auto value = [&](const MatrixExpression& of) { return evaluate(of, solution.values); };
  NamedMatrices gains;
  for (std::size_t timer = 0; timer < sum.timers(); ++timer) {
    Eigen::MatrixXd P = value(sum.P_constant() + sum.P(timer, 0));
    for (std::size_t other = 0; other < sum.timers(); ++other) {
      if (other == timer) continue;
      const std::size_t nodes = sum.nodes(other).size();
      for (std::size_t node = 0; node < nodes; ++node) {
        P += value(sum.P(other, node)) / static_cast<double>(nodes);
      }
    }
    const ErrorReset& reset = sum.system().resets[timer];
    gains[gain_of_sensor("L", subject, timer)] =
        solve_definite(P, solution.values.at("Y/" + reset.name));
  }
  return gains;
}

}  // namespace sampled_data_observers
