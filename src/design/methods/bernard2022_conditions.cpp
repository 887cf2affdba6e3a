#include <cmath>
#include <utility>

#include "certificate/theorems.h"
#include "design/methods/bernard2022_parameters.h"
#include "design/methods/gain_bound.h"
#include "design/methods/methods.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// bernard2022 (15), (22), (26): with L̃ = P L the conditions are linear, the one of the jump by a
/// Schur complement.
class QuadraticDesign : public LmiDesignMethod {
 public:
  QuadraticDesign(std::string name, std::string summary, const Theorem& theorem, bool in_flow,
                  bool at_jumps)
      : name_(std::move(name)),
        summary_(std::move(summary)),
        theorem_(theorem),
        in_flow_(in_flow),
        at_jumps_(at_jumps) {}

  std::string name() const override { return name_; }
  std::string summary() const override { return summary_; }
  const Theorem& theorem() const override { return theorem_; }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    const DesignParameter decay =
        has_dwell_time() ? decay_parameter_of(subject) : jump_decay_parameter();
    if (!in_flow_) return {flow_growth_parameter(subject), decay};
    return {flow_decay_parameter(subject, theorem()), decay, gain_bound_parameter()};
  }

  std::vector<std::string> bounded_gains(const CertificateSubject&) const override {
    if (in_flow_) return {"L_c"};
    return {};
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    // With T1 alone in the conditions there is no largest T2.
    if (in_flow_ || has_dwell_time()) return {Objective::kFeasible, Objective::kMaxDecay};
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay};
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    const ModeMatrices& plant = subject.plant.mode();
    const Eigen::Index n = subject.plant.states();
    const auto [a_c, a_d] =
        rates_of(subject, in_flow_ ? FlowOfError::kDecays : FlowOfError::kMayGrow, parameters);
    LmiProgram program;
    const MatrixExpression P = program.symmetric("P", n);
    program.require_positive("P > 0", P);
    program.bound_above("P <= I", P, identity(n));
    MatrixExpression flow = P * plant.A;
    MatrixExpression reset = P * *plant.A_d;
    if (in_flow_) {
      const MatrixExpression J = program.matrix("P L_c", n, plant.C_c.rows());
      flow = flow - J * plant.C_c;
      bound_gain(program, "L_c", P, J, parameters.at("gain_bound"));
    }
    if (at_jumps_) reset = reset - program.matrix("P L_d", n, plant.C_d.rows()) * plant.C_d;
    program.require_negative("flow", He(flow) - a_c * P);
    program.require_positive("jump",
                             symmetric_blocks({{std::exp(a_d) * P, transpose(reset)}, {P}}));
    return program;
  }

  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    NamedMatrices result;
    const Eigen::MatrixXd& P = solution.at("P");
    if (in_flow_) result["L_c"] = solve_linear(P, solution.at("P L_c"));
    if (at_jumps_) result["L_d"] = solve_linear(P, solution.at("P L_d"));
    return result;
  }

 private:
  bool has_dwell_time() const { return is_of_average(theorem_.times()); }

  std::string name_;
  std::string summary_;
  const Theorem& theorem_;
  bool in_flow_;
  bool at_jumps_;
};

}  // namespace

const DesignMethod& bernard2022_coupled_design() {
  static const QuadraticDesign method("bernard2022_equation15",
                                      "coupled gains L_c in flow and L_d at jumps",
                                      bernard2022_equation14(), true, true);
  return method;
}

const DesignMethod& bernard2022_coupled_average_design() {
  static const QuadraticDesign method(
      "bernard2022_equation15_average_dwell_time",
      "coupled gains L_c in flow and L_d at jumps, for jumps that are not too frequent on average",
      bernard2022_equation14_average_dwell_time(), true, true);
  return method;
}

const DesignMethod& bernard2022_flow_based_design() {
  static const QuadraticDesign method("bernard2022_equation22",
                                      "flow-based gain L_c, for jumps that are not too frequent",
                                      bernard2022_equation22(), true, false);
  return method;
}

const DesignMethod& bernard2022_flow_based_average_design() {
  static const QuadraticDesign method(
      "bernard2022_equation22_average_dwell_time",
      "flow-based gain L_c, for jumps that are not too frequent on average",
      bernard2022_equation22_average_dwell_time(), true, false);
  return method;
}

const DesignMethod& bernard2022_jump_based_design() {
  static const QuadraticDesign method("bernard2022_equation26",
                                      "jump-based gain L_d, for jumps that are frequent enough",
                                      bernard2022_equation26(), false, true);
  return method;
}

const DesignMethod& bernard2022_jump_based_average_design() {
  static const QuadraticDesign method(
      "bernard2022_equation26_reverse_average_dwell_time",
      "jump-based gain L_d, for jumps that are frequent enough on average",
      bernard2022_equation26_reverse_average_dwell_time(), false, true);
  return method;
}

}  // namespace sampled_data_observers
