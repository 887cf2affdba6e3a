#include <cmath>

#include "certificate/ferrante2019_matrix.h"
#include "design/methods/ferrante2019.h"
#include "design/methods/gain_bound.h"
#include "design/methods/methods.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// ferrante2019, Proposition 2: with J = P1 L and Y = (P2 (H + C L))ᵀ the conditions of Theorem 2
/// are linear. Y = 0 makes it a predictor (Remark 5).
class Proposition2 : public Ferrante2019Proposition {
 public:
  explicit Proposition2(Injection injection) : is_predictor_(injection == Injection::kPredictor) {}

  std::string name() const override {
    return is_predictor_ ? "ferrante2019_proposition2_predictor" : "ferrante2019_proposition2";
  }

  std::string summary() const override {
    return is_predictor_ ? "gain L of a predictor, H = -C L"
                         : "gain L and intersample injection H together, by cancelling C L C";
  }

  bool is_special_case() const override { return is_predictor_; }

  void restore(const CertificateSubject& subject, NamedMatrices& values) const override {
    if (is_predictor_) values["H"] = -(subject.plant.C() * values.at("L"));
  }

  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective objective) const override {
    const PlantMatrices plant = ferrante2019_plant(subject, parameters, objective);
    const Eigen::Index n = plant.states();
    const Eigen::Index m = plant.C().rows();
    LmiProgram program = ferrante2019_program(subject, parameters, objective);
    const MatrixExpression J = program.matrix("J", n, m);
    const MatrixExpression Y = is_predictor_ ? zeros(m, m) : program.matrix("Y", m, m);
    const MatrixExpression lambda_t = symbol("lambda_t");
    const double e = std::exp(parameters.at("delta") * subject.T2);
    program.require_negative("(34), first", ferrante2019_M(plant, 1.0, lambda_t, J, transpose(Y)));
    program.require_negative("(34), second", ferrante2019_M(plant, e, lambda_t, J, transpose(Y)));
    // LᵀL <= k² I, since Jᵀ P1⁻¹ J <= q k² I and P1 >= q I. Without it L grows without bound.
    const double k = kBoundShare * parameters.at("gain_bound");
    const MatrixExpression q = program.scalar("q");
    const MatrixExpression P1 = symbol("P1", n, n);
    program.bound_above("q I <= P1", q * identity(n), P1);
    program.bound_above("norm of L", zeros(n + m, n + m),
                        symmetric_blocks({{P1, J}, {k * k * q * identity(m)}}));
    return program;
  }

 protected:
  NamedMatrices any_gains(const CertificateSubject& subject,
                          const NamedMatrices& solution) const override {
    const Eigen::MatrixXd L = solve_linear(solution.at("P1"), solution.at("J"));
    Eigen::MatrixXd H = -(subject.plant.C() * L);
    if (!is_predictor_) H += solve_linear(solution.at("P2"), solution.at("Y").transpose());
    return {{"L", L}, {"H", H}};
  }

 private:
  bool is_predictor_;
};

}  // namespace

const DesignMethod& ferrante2019_proposition2() {
  static const Proposition2 method(Injection::kFree);
  return method;
}

const DesignMethod& ferrante2019_proposition2_predictor() {
  static const Proposition2 method(Injection::kPredictor);
  return method;
}

}  // namespace sampled_data_observers
