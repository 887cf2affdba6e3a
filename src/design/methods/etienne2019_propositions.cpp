#include <cmath>

#include "methods.h"
#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/certificate/wirtinger.h"

namespace sampled_data_observers {
namespace {

/// etienne2019: with G_1 = G_2 = G, G_3 = G_4 = 0 and Q = Gᵀ L the conditions (13) are linear.
class GainDesign : public LmiDesignMethod {
 public:
  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return {{"alpha", "twice the rate of convergence [1/s]", 0.1 / subject.T2, std::nullopt}};
  }

 protected:
  static LmiProgram common_program(const CertificateSubject& subject, double alpha,
                                   bool has_disturbance) {
    const PlantMatrices& plant = subject.plant;
    const Eigen::Index n = plant.states();
    const double wirtinger = wirtinger_constant(subject.T2);
    LmiProgram program;
    const MatrixExpression P = program.symmetric("P", n);
    const MatrixExpression X = program.symmetric("X", n);
    const MatrixExpression Y = program.symmetric("Y", n);
    const MatrixExpression G = program.matrix("G", n, n);
    const MatrixExpression Q = program.matrix("Q", n, plant.C().rows());
    program.require_positive("P > 0", P);
    program.require_positive("X > 0", X);
    program.require_positive("Y > 0", Y);
    const MatrixExpression QC = Q * plant.C();
    std::vector<Eigen::MatrixXd> vertices = plant.vertices;
    if (plant.is_linear()) vertices = {Eigen::MatrixXd::Zero(n, n)};
    for (const Eigen::MatrixXd& vertex : vertices) {
      const MatrixExpression R = Eigen::MatrixXd(plant.A() + vertex);
      const MatrixExpression GR = transpose(G) * R;
      for (const double rho : {1.0, std::exp(-alpha * subject.T2)}) {
        std::vector<std::vector<MatrixExpression>> rows = {
            {alpha * P + He(GR + QC), P + transpose(GR) - transpose(G) + transpose(QC), QC},
            {(rho * wirtinger) * X - He(G), QC - rho * Y},
            {-rho * X}};
        if (has_disturbance) {
          rows[0].push_back(transpose(G));
          rows[1].push_back(transpose(G));
          rows[2].push_back(zeros(n, n));
          rows.push_back({-(square("gamma") * identity(n))});
        }
        program.require_negative("(14)", symmetric_blocks(rows));
      }
    }
    return program;
  }

  static Eigen::MatrixXd gain(const NamedMatrices& solution) {
    return solve_linear(solution.at("G").transpose(), solution.at("Q"));
  }
};

class Proposition1Design : public GainDesign {
 public:
  std::string name() const override { return "etienne2019_proposition1"; }

  std::string summary() const override { return "held-innovation gain L for a rate alpha / 2"; }

  const Theorem& theorem() const override { return *find_theorem("etienne2019_proposition1"); }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay};
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    LmiProgram program = common_program(subject, parameters.at("alpha"), false);
    const Eigen::Index n = subject.plant.states();
    program.bound_above("P <= I", symbol("P", n, n), identity(n));
    return program;
  }

  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    return {{"L", gain(solution)}};
  }
};

/// Proposition 2 is an analysis; with the choice that makes Proposition 1 linear it gives gains,
/// too, after which the analysis is free in all of its matrices.
class Proposition2Design : public GainDesign {
 public:
  std::string name() const override { return "etienne2019_proposition2"; }

  std::string summary() const override {
    return "held-innovation gain L with a small gain gamma from noise and disturbance";
  }

  const Theorem& theorem() const override { return *find_theorem("etienne2019_proposition2"); }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMinGamma, Objective::kMaxT2, Objective::kMaxDecay};
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    LmiProgram program = common_program(subject, parameters.at("alpha"), true);
    const Eigen::Index n = subject.plant.states();
    program.bound_above("I <= P", identity(n), symbol("P", n, n));
    program.minimize(program.squared("gamma"));
    return program;
  }

  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    return {{"L", gain(solution)}};
  }
};

}  // namespace

const DesignMethod& etienne2019_proposition1_design() {
  static const Proposition1Design method;
  return method;
}

const DesignMethod& etienne2019_proposition2_design() {
  static const Proposition2Design method;
  return method;
}

}  // namespace sampled_data_observers
