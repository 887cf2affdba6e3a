#include <cmath>
#include <utility>

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
  QuadraticDesign(std::string number, std::string summary, std::string theorem, bool in_flow,
                  bool at_jumps)
      : number_(std::move(number)),
        summary_(std::move(summary)),
        theorem_(std::move(theorem)),
        in_flow_(in_flow),
        at_jumps_(at_jumps) {}

  std::string name() const override { return "bernard2022_equation" + number_; }
  std::string summary() const override { return summary_; }
  const Theorem& theorem() const override { return *find_theorem(theorem_); }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    if (in_flow_) {
      return {flow_decay_parameter(subject, theorem()), jump_decay_parameter(),
              gain_bound_parameter()};
    }
    return {{"flow_growth", "rate at which V may grow in flow, a_c [1/s]", std::nullopt,
             theorem().search_ranges(subject).front().range},
            jump_decay_parameter()};
  }

  std::vector<std::string> bounded_gains(const CertificateSubject&) const override {
    if (in_flow_) return {"L_c"};
    return {};
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    // With T1 alone in the conditions there is no largest T2.
    if (in_flow_) return {Objective::kFeasible, Objective::kMaxDecay};
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay};
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    const ModeMatrices& plant = subject.plant.mode();
    const Eigen::Index n = subject.plant.states();
    const double a_c = in_flow_ ? -parameters.at("flow_decay") : parameters.at("flow_growth");
    const double a_d =
        -a_c * (in_flow_ ? subject.T1 : subject.T2) - 2.0 * parameters.at("jump_decay");
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
  std::string number_;
  std::string summary_;
  std::string theorem_;
  bool in_flow_;
  bool at_jumps_;
};

}  // namespace

const DesignMethod& bernard2022_coupled_design() {
  static const QuadraticDesign method("15", "coupled gains L_c in flow and L_d at jumps",
                                      "bernard2022_equation14", true, true);
  return method;
}

const DesignMethod& bernard2022_flow_based_design() {
  static const QuadraticDesign method("22",
                                      "flow-based gain L_c, for jumps that are not too frequent",
                                      "bernard2022_equation22", true, false);
  return method;
}

const DesignMethod& bernard2022_jump_based_design() {
  static const QuadraticDesign method("26",
                                      "jump-based gain L_d, for jumps that are frequent enough",
                                      "bernard2022_equation26", false, true);
  return method;
}

}  // namespace sampled_data_observers
