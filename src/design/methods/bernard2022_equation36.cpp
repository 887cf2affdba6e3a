#include <cmath>

#include "design/methods/bernard2022_jump_based.h"
#include "design/methods/methods.h"
#include "design/polytopic_embedding.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// bernard2022 (36), and (37) and (45), its examples: (35) at the vertices M_i of a polytope that
/// holds e^{A_c τ} for all τ in [T1, T2].
class Remark54 : public JumpBasedDesign {
 public:
  std::string name() const override { return "bernard2022_equation36"; }
  std::string summary() const override {
    return "jump-based gain L_d for times between jumps of any length, where flow and jumps "
           "together are observable";
  }
  const Theorem& theorem() const override { return *find_theorem("bernard2022_corollary5_2"); }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    const ModeMatrices& plant = subject.plant.mode();
    const Eigen::Index n = subject.plant.states();
    const double kept = std::exp(-2.0 * parameters.at("jump_decay"));
    LmiProgram program;
    const MatrixExpression P = program.symmetric("P", n);
    const MatrixExpression J = program.matrix("P L_d", n, plant.C_d.rows());
    program.require_positive("P > 0", P);
    program.bound_above("P <= I", P, identity(n));
    const MatrixExpression reset = P * *plant.A_d - J * plant.C_d;
    for (const Eigen::MatrixXd& M : polytopic_embedding(plant.A, subject.T1, subject.T2)) {
      program.require_positive("(36)", symmetric_blocks({{kept * P, transpose(reset * M)}, {P}}));
    }
    return program;
  }

  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    return {{"L_d", solve_linear(solution.at("P"), solution.at("P L_d"))}};
  }
};

}  // namespace

const DesignMethod& bernard2022_polytopic_design() {
  static const Remark54 method;
  return method;
}

}  // namespace sampled_data_observers
