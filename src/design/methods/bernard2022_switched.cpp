#include <cmath>
#include <utility>

#include "certificate/theorems.h"
#include "design/methods/bernard2022_jump_based.h"
#include "design/methods/bernard2022_parameters.h"
#include "design/methods/gain_bound.h"
#include "design/methods/methods.h"
#include "design/polytopic_embedding.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// bernard2022 (47b) and (49), as in example 7.1: with L̃_q = P_q L_q the conditions of all modes
/// are linear. Gains at switches, which are right of the P' of every next mode, take as in section
/// 7.3.2 a matrix G of their own.
class RatesOfModesDesign : public LmiDesignMethod {
 public:
  RatesOfModesDesign(std::string name, std::string summary, const Theorem& theorem,
                     FlowOfError kind)
      : name_(std::move(name)), summary_(std::move(summary)), theorem_(theorem), kind_(kind) {}

  std::string name() const override { return name_; }
  std::string summary() const override { return summary_; }
  const Theorem& theorem() const override { return theorem_; }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    const DesignParameter decay =
        is_of_average(theorem_.times()) ? decay_parameter_of(subject) : jump_decay_parameter();
    if (!in_flow()) return {flow_growth_parameter(subject), decay};
    return {flow_decay_parameter(subject, theorem_), decay, gain_bound_parameter()};
  }

  std::vector<std::string> bounded_gains(const CertificateSubject& subject) const override {
    std::vector<std::string> all;
    if (!in_flow()) return all;
    for (const ModeMatrices& mode : subject.plant.modes) all.push_back(of_mode("L_c", mode));
    return all;
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxDecay};
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    const Eigen::Index n = subject.plant.states();
    const NumericRates rates = rates_of(subject, kind_, parameters);
    LmiProgram program;
    for (const ModeMatrices& mode : subject.plant.modes) {
      const MatrixExpression P = program.symmetric(of_mode("P", mode), n);
      program.require_positive("P > 0", P);
      program.bound_above("P <= I", P, identity(n));
      MatrixExpression flow = P * mode.A;
      if (in_flow()) {
        const MatrixExpression J = program.matrix(of_mode("P L_c", mode), n, mode.C_c.rows());
        flow = flow - J * mode.C_c;
        bound_gain(program, of_mode("L_c", mode), P, J, parameters.at("gain_bound"));
      }
      program.require_negative("(47b)", He(flow) - rates.a_c * P);
    }
    for (const ModeMatrices& mode : subject.plant.modes) {
      require_at_switches(subject, mode, std::exp(rates.a_d), program);
    }
    return program;
  }

  NamedMatrices gains(const CertificateSubject& subject, const Parameters&,
                      const NamedMatrices& solution) const override {
    NamedMatrices result;
    for (const ModeMatrices& mode : subject.plant.modes) {
      const std::string gain = in_flow() ? "L_c" : "L_d";
      const std::string factor = in_flow() ? "P" : "G";
      result[of_mode(gain, mode)] = solve_linear(solution.at(of_mode(factor, mode)),
                                                 solution.at(of_mode(factor + " " + gain, mode)));
    }
    return result;
  }

 private:
  bool in_flow() const { return kind_ == FlowOfError::kDecays; }

  /// (49), for switches that leave a mode.
  void require_at_switches(const CertificateSubject& subject, const ModeMatrices& mode,
                           double factor, LmiProgram& program) const {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression kept = factor * symbol(of_mode("P", mode), n, n);
    const MatrixExpression A_d = jump_of(mode);
    if (in_flow()) {
      for (const ModeMatrices& next : subject.plant.modes) {
        program.require_positive("(49)",
                                 kept - transpose(A_d) * symbol(of_mode("P", next), n, n) * A_d);
      }
      return;
    }
    const MatrixExpression G = program.matrix(of_mode("G", mode), n, n);
    const MatrixExpression reset =
        G * A_d - program.matrix(of_mode("G L_d", mode), n, mode.C_d.rows()) * mode.C_d;
    for (const ModeMatrices& next : subject.plant.modes) {
      program.require_positive(
          "(49)",
          symmetric_blocks({{kept, transpose(reset)}, {He(G) - symbol(of_mode("P", next), n, n)}}));
    }
  }

  std::string name_;
  std::string summary_;
  const Theorem& theorem_;
  FlowOfError kind_;
};

/// bernard2022, section 7.3.2, as (36) for each mode. The gain is right of the P' of every next
/// mode; a matrix G of its own instead, with G + Gᵀ − P' <= G P'⁻¹ Gᵀ, keeps this linear.
class SwitchedJumpBased : public JumpBasedDesign {
 public:
  std::string name() const override { return "bernard2022_section7_3_2"; }
  std::string summary() const override {
    return "jump-based gain L_d for each mode of a switched plant whose every switch changes the "
           "mode";
  }
  const Theorem& theorem() const override { return *find_theorem("bernard2022_section7_3_2"); }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    const Eigen::Index n = subject.plant.states();
    const double kept = std::exp(-2.0 * parameters.at("jump_decay"));
    LmiProgram program;
    for (const ModeMatrices& mode : subject.plant.modes) {
      const MatrixExpression P = program.symmetric(of_mode("P", mode), n);
      program.require_positive("P > 0", P);
      program.bound_above("P <= I", P, identity(n));
    }
    for (const ModeMatrices& mode : subject.plant.modes) {
      const MatrixExpression P = symbol(of_mode("P", mode), n, n);
      const MatrixExpression G = program.matrix(of_mode("G", mode), n, n);
      const MatrixExpression J = program.matrix(of_mode("G L_d", mode), n, mode.C_d.rows());
      const MatrixExpression reset = G * jump_of(mode) - J * mode.C_d;
      for (const Eigen::MatrixXd& M : polytopic_embedding(mode.A, subject.T1, subject.T2)) {
        for (const ModeMatrices& next : subject.plant.modes) {
          if (&next == &mode) continue;
          program.require_positive("(52)",
                                   symmetric_blocks({{kept * P, transpose(reset * M)},
                                                     {He(G) - symbol(of_mode("P", next), n, n)}}));
        }
      }
    }
    return program;
  }

  NamedMatrices gains(const CertificateSubject& subject, const Parameters&,
                      const NamedMatrices& solution) const override {
    NamedMatrices result;
    for (const ModeMatrices& mode : subject.plant.modes) {
      result[of_mode("L_d", mode)] =
          solve_linear(solution.at(of_mode("G", mode)), solution.at(of_mode("G L_d", mode)));
    }
    return result;
  }
};

}  // namespace

const DesignMethod& bernard2022_switched_flow_based_design() {
  static const RatesOfModesDesign method(
      "bernard2022_example7_1",
      "flow-based gain L_c for each mode of a switched plant, for slow switching",
      bernard2022_example7_1(), FlowOfError::kDecays);
  return method;
}

const DesignMethod& bernard2022_switched_flow_based_average_design() {
  static const RatesOfModesDesign method("bernard2022_example7_1_average_dwell_time",
                                         "flow-based gain L_c for each mode of a switched plant, "
                                         "for switching that is slow on average",
                                         bernard2022_example7_1_average_dwell_time(),
                                         FlowOfError::kDecays);
  return method;
}

const DesignMethod& bernard2022_switched_jump_based_average_design() {
  static const RatesOfModesDesign method(
      "bernard2022_equation49_reverse_average_dwell_time",
      "jump-based gain L_d for each mode of a switched plant, for switching that is frequent on "
      "average",
      bernard2022_equation49_reverse_average_dwell_time(), FlowOfError::kMayGrow);
  return method;
}

const DesignMethod& bernard2022_switched_jump_based_design() {
  static const SwitchedJumpBased method;
  return method;
}

}  // namespace sampled_data_observers
