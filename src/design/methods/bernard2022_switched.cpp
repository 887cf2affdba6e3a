#include <cmath>

#include "design/methods/bernard2022_jump_based.h"
#include "design/methods/bernard2022_parameters.h"
#include "design/methods/gain_bound.h"
#include "design/methods/methods.h"
#include "design/polytopic_embedding.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// bernard2022, example 7.1: with L̃_q = P_q L_q the conditions of all modes are linear.
class SwitchedFlowBased : public LmiDesignMethod {
 public:
  std::string name() const override { return "bernard2022_example7_1"; }
  std::string summary() const override {
    return "flow-based gain L_c for each mode of a switched plant, for slow switching";
  }
  const Theorem& theorem() const override { return *find_theorem("bernard2022_example7_1"); }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return {flow_decay_parameter(subject, theorem()), jump_decay_parameter(),
            gain_bound_parameter()};
  }

  std::vector<std::string> bounded_gains(const CertificateSubject& subject) const override {
    std::vector<std::string> all;
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
    const double flow_decay = parameters.at("flow_decay");
    const double a_d = flow_decay * subject.T1 - 2.0 * parameters.at("jump_decay");
    LmiProgram program;
    for (const ModeMatrices& mode : subject.plant.modes) {
      const MatrixExpression P = program.symmetric(of_mode("P", mode), n);
      const MatrixExpression J = program.matrix(of_mode("P L_c", mode), n, mode.C_c.rows());
      program.require_positive("P > 0", P);
      program.bound_above("P <= I", P, identity(n));
      program.require_negative("(47b)", He(P * mode.A - J * mode.C_c) + flow_decay * P);
      bound_gain(program, of_mode("L_c", mode), P, J, parameters.at("gain_bound"));
    }
    for (const ModeMatrices& mode : subject.plant.modes) {
      const MatrixExpression P = symbol(of_mode("P", mode), n, n);
      const MatrixExpression A_d = jump_of(mode);
      for (const ModeMatrices& next : subject.plant.modes) {
        program.require_positive(
            "(49)", std::exp(a_d) * P - transpose(A_d) * symbol(of_mode("P", next), n, n) * A_d);
      }
    }
    return program;
  }

  NamedMatrices gains(const CertificateSubject& subject, const Parameters&,
                      const NamedMatrices& solution) const override {
    NamedMatrices result;
    for (const ModeMatrices& mode : subject.plant.modes) {
      result[of_mode("L_c", mode)] =
          solve_linear(solution.at(of_mode("P", mode)), solution.at(of_mode("P L_c", mode)));
    }
    return result;
  }
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
  static const SwitchedFlowBased method;
  return method;
}

const DesignMethod& bernard2022_switched_jump_based_design() {
  static const SwitchedJumpBased method;
  return method;
}

}  // namespace sampled_data_observers
