#include "certificate/theorems.h"
#include "design/methods/bernard2022_parameters.h"
#include "design/methods/gain_bound.h"
#include "design/methods/methods.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// bernard2022, section 7.3.1. With N an orthonormal basis of the null space of H, all P_q that
/// differ by dᵀ H + Hᵀ d are N X Nᵀ + N Y_q H + Hᵀ Y_qᵀ Nᵀ + Hᵀ Z_q H with one X.
class ProjectionDesign : public LmiDesignMethod {
 public:
  std::string name() const override { return theorem().name(); }
  std::string summary() const override {
    return "flow-based gain L_c and projection for each mode of a switched plant, for any "
           "switching";
  }
  const Theorem& theorem() const override { return bernard2022_section7_3_1(); }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return {decay_parameter_of(subject), gain_bound_parameter()};
  }

  std::vector<std::string> bounded_gains(const CertificateSubject& subject) const override {
    std::vector<std::string> all;
    for (const ModeMatrices& mode : subject.plant.modes) all.push_back(of_mode("L_c", mode));
    return all;
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxDecay};
  }

  void restore(const CertificateSubject& subject, NamedMatrices& values) const override {
    for (const ModeMatrices& mode : subject.plant.modes) {
      Eigen::MatrixXd& metric = values.at(of_mode("projection", mode));
      metric = ((metric + metric.transpose()) / 2.0).eval();
    }
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    const Eigen::Index n = subject.plant.states();
    const Eigen::MatrixXd H_value = output_at_switches(subject.plant.mode());
    const Eigen::Index m = H_value.rows();
    const Eigen::MatrixXd N_value = null_space(H_value);
    const MatrixExpression H = H_value;
    LmiProgram program;
    MatrixExpression common = zeros(n, n);
    if (N_value.cols() > 0) {
      const MatrixExpression N = N_value;
      common = N * program.symmetric("X", N_value.cols()) * transpose(N);
    }
    for (const ModeMatrices& mode : subject.plant.modes) {
      MatrixExpression P = common + transpose(H) * program.symmetric(of_mode("Z", mode), m) * H;
      if (N_value.cols() > 0) {
        P = P + He(MatrixExpression(N_value) *
                   program.matrix(of_mode("Y", mode), N_value.cols(), m) * H);
      }
      const MatrixExpression J = program.matrix(of_mode("P L_c", mode), n, mode.C_c.rows());
      program.require_positive("P > 0", P);
      program.bound_above("P <= I", P, identity(n));
      program.require_negative("(47b)",
                               He(P * mode.A - J * mode.C_c) + 2.0 * parameters.at("decay") * P);
      bound_gain(program, of_mode("L_c", mode), P, J, parameters.at("gain_bound"));
    }
    return program;
  }

  NamedMatrices gains(const CertificateSubject& subject, const Parameters&,
                      const NamedMatrices& solution) const override {
    const Eigen::MatrixXd H = output_at_switches(subject.plant.mode());
    const Eigen::MatrixXd N = null_space(H);
    NamedMatrices result;
    for (const ModeMatrices& mode : subject.plant.modes) {
      Eigen::MatrixXd P = H.transpose() * solution.at(of_mode("Z", mode)) * H;
      if (N.cols() > 0) {
        const Eigen::MatrixXd mixed = N * solution.at(of_mode("Y", mode)) * H;
        P += N * solution.at("X") * N.transpose() + mixed + mixed.transpose();
      }
      P = ((P + P.transpose()) / 2.0).eval();
      result[of_mode("projection", mode)] = P;
      result[of_mode("L_c", mode)] = solve_linear(P, solution.at(of_mode("P L_c", mode)));
    }
    return result;
  }
};

}  // namespace

const DesignMethod& bernard2022_projection_design() {
  static const ProjectionDesign method;
  return method;
}

}  // namespace sampled_data_observers
