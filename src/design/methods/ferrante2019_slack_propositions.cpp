#include <cmath>
#include <stdexcept>
#include <utility>

#include "ferrante2019.h"
#include "methods.h"
#include "sampled_data_observers/certificate/ferrante2019_matrix.h"
#include "sampled_data_observers/certificate/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// The slack matrices of (37) that are left when X2 = X4 = 0, with their products with H; X1 = X,
/// X3 = a X and Xᵀ L = J are common to all propositions.
struct Slack {
  MatrixExpression X5;    ///< m x n
  MatrixExpression X6;    ///< m x m
  MatrixExpression X7;    ///< m x n
  MatrixExpression X8;    ///< m x m
  MatrixExpression X6_H;  ///< X6ᵀ H
  MatrixExpression X8_H;  ///< X8ᵀ H
};

/// Which slack matrices a proposition leaves free.
enum class Choice {
  kProposition3,  ///< X6 = Y6 = U, X8 = Y8 = 0
  kProposition4,  ///< X6 = Y6 = X8 = Y8 = U
  kProposition5   ///< H = 0; X5 to X8 and Y5 to Y8 all free
};

/// ferrante2019, Propositions 3, 4 and 5: choices of the slack matrices of Theorem 3 for which its
/// inequalities (36) are linear.
class SlackProposition : public Ferrante2019Proposition {
 public:
  SlackProposition(Choice choice, std::string name, std::string summary)
      : choice_(choice), name_(std::move(name)), summary_(std::move(summary)) {}

  std::string name() const override { return name_; }
  std::string summary() const override { return summary_; }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    std::vector<DesignParameter> all = Ferrante2019Proposition::parameters(subject);
    all.push_back({"a", "scale of the slack matrix X3 = a X1, 1 in the paper [1/s]", 1.0,
                   SearchRange{0.03 / subject.T2, 30.0 / subject.T2, true}});
    return all;
  }

  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective objective) const override {
    const double delta = parameters.at("delta");
    // The weight of the held innovation stands alone on the diagonal.
    if (choice_ != Choice::kProposition4 && delta <= 2.0 * parameters.at("lambda_t")) {
      throw std::invalid_argument(name_ + " needs delta > 2 lambda_t");
    }
    const PlantMatrices& plant = subject.plant;
    const Eigen::Index n = plant.states();
    const Eigen::Index m = plant.C().rows();
    LmiProgram program = ferrante2019_program(subject, parameters, objective);
    const MatrixExpression X = program.matrix("X", n, n);
    const MatrixExpression J = program.matrix("J", n, m);
    const double a = parameters.at("a");
    const auto [at_0, at_T2] = slacks(program, n, m);
    program.require_negative("(36), first", inequality(plant, 1.0, a, at_0));
    program.require_negative("(36), second",
                             inequality(plant, std::exp(delta * subject.T2), a, at_T2));
    // ‖L‖ <= ‖J‖/σ_min(X) <= k.
    const double k = parameters.at("gain_bound");
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
    gains["H"] = choice_ == Choice::kProposition5
                     ? Eigen::MatrixXd::Zero(J.cols(), J.cols())
                     : solve_linear(solution.at("U").transpose(), solution.at("W"));
    return gains;
  }

 private:
  /// Those of the first and of the second inequality.
  std::pair<Slack, Slack> slacks(LmiProgram& program, Eigen::Index n, Eigen::Index m) const {
    const MatrixExpression zero = zeros(m, m);
    if (choice_ == Choice::kProposition5) {
      const auto all_free = [&](const std::string& letter) {
        return Slack{program.matrix(letter + "5", m, n),
                     program.matrix(letter + "6", m, m),
                     program.matrix(letter + "7", m, n),
                     program.matrix(letter + "8", m, m),
                     zero,
                     zero};
      };
      Slack first = all_free("X");
      return {std::move(first), all_free("Y")};
    }
    const MatrixExpression U = program.matrix("U", m, m);
    const MatrixExpression W = program.matrix("W", m, m);
    const bool has_X8 = choice_ == Choice::kProposition4;
    const Slack slack = {zeros(m, n), U, zeros(m, n), has_X8 ? U : zero, W, has_X8 ? W : zero};
    return {slack, slack};
  }

  /// The left-hand side of (36), which with e = e^{δ T2} has P_T2 where it has P with e = 1.
  static MatrixExpression inequality(const PlantMatrices& plant, double e, double a,
                                     const Slack& slack) {
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

    const MatrixExpression S1 =
        blocks({{-X + Ct * slack.X5, Ct * slack.X6}, {-slack.X5, -slack.X6}});
    const MatrixExpression S2_and_P =
        blocks({{flow - a * X + Ct * slack.X7 + P1, Ct * slack.X8 + J},
                {-(slack.X6_H * C) - slack.X7, slack.X6_H - slack.X8 + e * P2}});
    const MatrixExpression S5 = blocks({{a * transpose(flow), -(Ct * transpose(slack.X8_H))},
                                        {a * transpose(J), transpose(slack.X8_H)}});
    const MatrixExpression weight =
        blocks({{ferrante2019_error_weight(plant, lambda_t), zeros(n, m)},
                {zeros(m, n), e * ((2.0 * lambda_t - symbol("delta")) * P2)}});
    return ferrante2019_with_inputs(
        plant, {{He(S1), S2_and_P}, {weight + He(S5)}}, [&](const MatrixExpression& input) {
          const MatrixExpression X_input =
              blocks({{transpose(X) * input}, {zeros(m, input.cols())}});
          return std::vector<MatrixExpression>{X_input, a * X_input};
        });
  }

  Choice choice_;
  std::string name_;
  std::string summary_;
};

}  // namespace

const DesignMethod& ferrante2019_proposition3() {
  static const SlackProposition method(
      Choice::kProposition3, "ferrante2019_proposition3",
      "gain L and intersample injection H by slack matrices, for delta > 2 lambda_t");
  return method;
}

const DesignMethod& ferrante2019_proposition4() {
  static const SlackProposition method(Choice::kProposition4, "ferrante2019_proposition4",
                                       "gain L and intersample injection H by slack matrices");
  return method;
}

const DesignMethod& ferrante2019_proposition5() {
  static const SlackProposition method(Choice::kProposition5, "ferrante2019_proposition5",
                                       "gain L for a held innovation, H = 0, by slack matrices");
  return method;
}

}  // namespace sampled_data_observers
