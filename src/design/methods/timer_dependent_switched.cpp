#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "certificate/timer_dependent_theorem.h"
#include "certificate/timer_grid.h"
#include "design/methods/ferrante2019.h"
#include "design/methods/methods.h"
#include "design/methods/timer_dependent.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Of two modes each switch leads into the other one, q': P just after it is P_q',0 always, so that
/// with Y_q = P_q',0 K_q the conditions are linear in all P and Y. Where several modes may follow,
/// a matrix X_q stands for all their P_q',0, Y_q = X_q K_q: since X P⁻¹ Xᵀ >= X + Xᵀ − P, the jump
/// conditions hold if they do with X_q in the place of P_q',0 beside K_q and X_q + X_qᵀ − P_q',0 in
/// its other one.
class GainsAtSwitches : public LmiDesignMethod {
 public:
  std::string name() const override { return "timer_dependent_switched_gain"; }
  std::string summary() const override {
    return "gains L_d at switches between modes, by a Lyapunov function of each that depends on "
           "the time since the last switch";
  }
  const Theorem& theorem() const override { return *find_theorem("timer_dependent_switched"); }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return timer_dependent_parameters(subject);
  }
  std::vector<Objective> objectives(const CertificateSubject& subject) const override {
    std::vector<Objective> all;
    for (const Objective objective : timer_dependent_objectives(subject)) {
      if (objective != Objective::kMinFinalError) all.push_back(objective);
    }
    return all;
  }

  void require_applicable(const CertificateSubject& subject) const override {
    require_subject(theorem(), subject);
    const PlantMatrices& plant = subject.plant;
    if (plant.mode().C_c.rows() == 0 && plant.mode().C_d.rows() > 0) return;
    throw std::invalid_argument("it is about outputs at switches alone");
  }

  LmiProgram program(const CertificateSubject& given, const Parameters& parameters,
                     Objective objective) const override {
    const CertificateSubject subject = timer_dependent_subject(given, parameters, objective);
    const Eigen::Index n = subject.plant.states();
    const bool is_homogeneous = subject.plant.N.cols() == 0;
    LmiProgram program;
    std::vector<TimerDependentFunction> functions;
    for (std::size_t i = 0; i < subject.plant.modes.size(); ++i) {
      const ModeMatrices& mode = subject.plant.modes[i];
      const MatrixExpression Y = program.matrix(of_mode("Y", mode), n, mode.C_d.rows());
      functions.emplace_back(
          switched_error(subject, i), grid_of(subject), shortest_times(subject),
          GainProducts{[product = Y](std::size_t, std::size_t) { return product; }});
    }
    for (const NamedShape& shape : theorem().multipliers(subject)) {
      if (shape.form != NamedShape::Form::kSymmetric) {
        program.bound_above(shape.name + " <= limit", program.scalar(shape.name), kLargestLevel);
        continue;
      }
      const MatrixExpression P = program.symmetric(shape.name, shape.rows);
      if (is_homogeneous) program.bound_above(shape.name + " <= I", P, identity(shape.rows));
    }
    program.fix("lambda_t", scalar_matrix(parameters.at("lambda_t")));
    add_gamma(program, subject, parameters, objective);
    for (std::size_t i = 0; i < functions.size(); ++i) {
      for (const Condition& condition : functions[i].flow_conditions()) {
        program.require(condition, 1);
      }
      if (functions.size() == 2) {
        for (const Condition& condition : functions[i].jumps_into(functions[1 - i], 0)) {
          program.require(condition, 1);
        }
        continue;
      }
      const ModeMatrices& mode = subject.plant.modes[i];
      const MatrixExpression X = program.matrix(of_mode("X", mode), n, n);
      for (const TimerDependentFunction& next : functions) {
        if (&next != &functions[i]) require_jumps(program, functions[i], next, mode, X);
      }
    }
    return program;
  }

 protected:
  NamedMatrices gains(const CertificateSubject& subject, const Parameters&,
                      const NamedMatrices& solution) const override {
    NamedMatrices values;
    for (std::size_t i = 0; i < subject.plant.modes.size(); ++i) {
      const ModeMatrices& mode = subject.plant.modes[i];
      const Eigen::MatrixXd& Y = solution.at(of_mode("Y", mode));
      if (subject.plant.modes.size() == 2) {
        const std::string after = of_mode("P", subject.plant.modes[1 - i]) + "/0";
        values[of_mode("L_d", mode)] = solve_definite(solution.at(after), Y);
      } else {
        values[of_mode("L_d", mode)] = inverse_of(solution.at(of_mode("X", mode))) * Y;
      }
    }
    return values;
  }

 private:
  /// Those from one mode into another one that may follow.
  static void require_jumps(LmiProgram& program, const TimerDependentFunction& function,
                            const TimerDependentFunction& next, const ModeMatrices& mode,
                            const MatrixExpression& X) {
    const Eigen::Index n = mode.A.rows();
    const Eigen::Index m = mode.C_d.rows();
    const MatrixExpression J = jump_of(mode);
    const MatrixExpression C = mode.C_d;
    const MatrixExpression Y = symbol(of_mode("Y", mode), n, m);
    for (std::size_t node = 0; node < function.grid().size(); ++node) {
      if (!function.is_foreseen(0, node)) continue;
      program.require_positive(
          "jump", symmetric_blocks({{function.P(node), zeros(n, m), transpose(X * J - Y * C)},
                                    {symbol("nu/jumps") * identity(m), -transpose(Y)},
                                    {X + transpose(X) - next.P(0)}}));
    }
  }

  /// Of noise, in the units of the attempt: without one the program has no end.
  static constexpr double kLargestLevel = 1e6;
};

}  // namespace

const DesignMethod& timer_dependent_switched_design() {
  static const GainsAtSwitches method;
  return method;
}

}  // namespace sampled_data_observers
