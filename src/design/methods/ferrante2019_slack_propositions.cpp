#include <cmath>
#include <stdexcept>
#include <utility>

#include "certificate/ferrante2019_matrix.h"
#include "design/methods/ferrante2019.h"
#include "design/methods/gain_bound.h"
#include "design/methods/methods.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// How a proposition chooses the slack matrices of (37). Common to all are X1 = X, X2 = X4 = 0,
/// X3 = a X and Xᵀ L = J.
enum class Choice {
  kProposition3,  ///< X6 = Y6 = U, X8 = Y8 = 0, and X5 = X7 = Y5 = Y7 = 0
  kProposition4,  ///< X6 = Y6 = X8 = Y8 = U, and X5 = X7 = Y5 = Y7 = 0
  kProposition5   ///< H = 0; X5 to X8 and Y5 to Y8 all free
};

/// ferrante2019, Propositions 3, 4 and 5: choices of the slack matrices of Theorem 3 for which its
/// inequalities (36) are linear.
///
/// The free ones of Proposition 5 stand in (36) as He([C −I 0 0]ᵀ [X5 X6 X7 X8]). By the projection
/// lemma there are such matrices if and only if (36) without them holds on the kernel of
/// [C −I 0 0]; that is what is solved, a program with half the variables.
class SlackProposition : public Ferrante2019Proposition {
 public:
  SlackProposition(Choice choice, Injection injection, std::string name, std::string summary)
      : choice_(choice),
        is_held_(injection == Injection::kHold),
        name_(std::move(name)),
        summary_(std::move(summary)) {}

  std::string name() const override { return name_; }
  std::string summary() const override { return summary_; }
  bool is_special_case() const override { return is_held_ && choice_ != Choice::kProposition5; }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    std::vector<DesignParameter> all = Ferrante2019Proposition::parameters(subject);
    all.push_back(
        {"a", "scale of the slack matrix X3 = a X1 [1/s], 1 in the paper; 0.25/T2 where not given",
         0.25 / subject.T2, SearchRange{0.03 / subject.T2, 30.0 / subject.T2, true}});
    return all;
  }

  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective objective) const override {
    const double delta = parameters.at("delta");
    // The weight of the held innovation stands alone on the diagonal.
    if (choice_ != Choice::kProposition4 && delta <= 2.0 * parameters.at("lambda_t")) {
      throw std::invalid_argument(name_ + " needs delta > 2 lambda_t");
    }
    const PlantMatrices plant = ferrante2019_plant(subject, parameters, objective);
    const Eigen::Index n = plant.states();
    const Eigen::Index m = plant.C().rows();
    LmiProgram program = ferrante2019_program(subject, parameters, objective);
    const MatrixExpression X = program.matrix("X", n, n);
    const MatrixExpression J = program.matrix("J", n, m);
    const double a = parameters.at("a");
    if (choice_ != Choice::kProposition5) {
      program.matrix("U", m, m);
      if (!is_held_) program.matrix("W", m, m);  // Uᵀ H
    }
    program.require_negative("(36), first", inequality(plant, 1.0, a));
    program.require_negative("(36), second", inequality(plant, std::exp(delta * subject.T2), a));
    // ‖L‖ <= ‖J‖/σ_min(X) <= k.
    const double k = kBoundShare * parameters.at("gain_bound");
    const MatrixExpression q = program.scalar("q");
    program.bound_above("2 q I <= X + X^T", 2.0 * q * identity(n), He(X));
    program.bound_above("norm of J", zeros(n + m, n + m),
                        symmetric_blocks({{k * q * identity(n), J}, {k * q * identity(m)}}));
    return program;
  }

 protected:
  NamedMatrices any_gains(const CertificateSubject&, const NamedMatrices& solution) const override {
    const Eigen::MatrixXd& J = solution.at("J");
    NamedMatrices gains;
    gains["L"] = solve_linear(solution.at("X").transpose(), J);
    gains["H"] = is_held_ ? Eigen::MatrixXd::Zero(J.cols(), J.cols())
                          : solve_linear(solution.at("U").transpose(), solution.at("W"));
    return gains;
  }

 private:
  /// The left-hand side of (36), which with e = e^{δ T2} has P_T2 where it has P with e = 1.
  MatrixExpression inequality(const PlantMatrices& plant, double e, double a) const {
    const MatrixExpression A = plant.A();
    const MatrixExpression C = plant.C();
    const Eigen::Index n = A.rows();
    const Eigen::Index m = C.rows();
    const MatrixExpression P1 = symbol("P1", n, n);
    const MatrixExpression P2 = symbol("P2", m, m);
    const MatrixExpression X = symbol("X", n, n);
    const MatrixExpression J = symbol("J", n, m);
    const MatrixExpression lambda_t = symbol("lambda_t");
    const MatrixExpression flow = transpose(X) * A - J * C;
    const MatrixExpression Ct = transpose(C);
    const bool is_free = choice_ == Choice::kProposition5;

    const MatrixExpression zero = zeros(m, m);
    const MatrixExpression X6 = is_free ? zero : symbol("U", m, m);
    const MatrixExpression X6_H = is_held_ ? zero : symbol("W", m, m);
    const bool has_X8 = choice_ == Choice::kProposition4;
    const MatrixExpression X8 = has_X8 ? X6 : zero;
    const MatrixExpression X8_H = has_X8 ? X6_H : zero;
    const MatrixExpression S1 = blocks({{-X, Ct * X6}, {zeros(m, n), -X6}});
    const MatrixExpression S2_and_P =
        blocks({{flow - a * X + P1, Ct * X8 + J}, {-(X6_H * C), X6_H - X8 + e * P2}});
    const MatrixExpression S5 = blocks(
        {{a * transpose(flow), -(Ct * transpose(X8_H))}, {a * transpose(J), transpose(X8_H)}});
    const MatrixExpression weight =
        blocks({{ferrante2019_error_weight(plant, lambda_t), zeros(n, m)},
                {zeros(m, n), e * ((2.0 * lambda_t - symbol("delta")) * P2)}});
    const MatrixExpression onto = is_free ? blocks({{identity(n), Ct}}) : identity(n + m);
    return ferrante2019_with_inputs(
        plant, {{onto * He(S1) * transpose(onto), onto * S2_and_P}, {weight + He(S5)}},
        [&](const MatrixExpression& input) {
          const MatrixExpression X_input =
              blocks({{transpose(X) * input}, {zeros(m, input.cols())}});
          return std::vector<MatrixExpression>{onto * X_input, a * X_input};
        });
  }

  Choice choice_;
  bool is_held_;
  std::string name_;
  std::string summary_;
};

}  // namespace

const DesignMethod& ferrante2019_proposition3() {
  static const SlackProposition method(
      Choice::kProposition3, Injection::kFree, "ferrante2019_proposition3",
      "gain L and intersample injection H by slack matrices, for delta > 2 lambda_t");
  return method;
}

const DesignMethod& ferrante2019_proposition4() {
  static const SlackProposition method(Choice::kProposition4, Injection::kFree,
                                       "ferrante2019_proposition4",
                                       "gain L and intersample injection H by slack matrices");
  return method;
}

const DesignMethod& ferrante2019_proposition5() {
  static const SlackProposition method(Choice::kProposition5, Injection::kHold,
                                       "ferrante2019_proposition5",
                                       "gain L for a held innovation, H = 0, by slack matrices");
  return method;
}

const DesignMethod& ferrante2019_proposition3_hold() {
  static const SlackProposition method(
      Choice::kProposition3, Injection::kHold, "ferrante2019_proposition3_hold",
      "gain L for a held innovation, H = 0, by the slack matrices of Proposition 3");
  return method;
}

const DesignMethod& ferrante2019_proposition4_hold() {
  static const SlackProposition method(
      Choice::kProposition4, Injection::kHold, "ferrante2019_proposition4_hold",
      "gain L for a held innovation, H = 0, by the slack matrices of Proposition 4");
  return method;
}

}  // namespace sampled_data_observers
