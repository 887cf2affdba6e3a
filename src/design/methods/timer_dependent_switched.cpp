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

/// Two modes, of which each switch leads into the other one, q': P just after it is P_q',0 always,
/// so that with Y_q = P_q',0 K_q the conditions are linear in all P and Y.
class GainsAtSwitches : public LmiDesignMethod {
 public:
  std::string name() const override { return "timer_dependent_switched_gain"; }
  std::string summary() const override {
    return "gains L_d at switches between two modes, by a Lyapunov function of each that depends "
           "on the time since the last switch";
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
    if (plant.modes.size() != 2) {
      throw std::invalid_argument("it is about two modes; 'design analyze' is about more");
    }
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
      for (const Condition& condition : functions[i].jumps_into(functions[1 - i], 0)) {
        program.require(condition, 1);
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
      const std::string after = of_mode("P", subject.plant.modes[1 - i]) + "/0";
      values[of_mode("L_d", mode)] =
          solve_definite(solution.at(after), solution.at(of_mode("Y", mode)));
    }
    return values;
  }

 private:
  /// Of noise, in the units of the attempt: without one the program has no end.
  static constexpr double kLargestLevel = 1e6;
};

}  // namespace

const DesignMethod& timer_dependent_switched_design() {
  static const GainsAtSwitches method;
  return method;
}

}  // namespace sampled_data_observers
