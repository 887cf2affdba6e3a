#include <cmath>
#include <utility>

#include "methods.h"
#include "sampled_data_observers/certificate/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// ferrante2019, Proposition 2: with J = P1 L and Y = (P2 (H + C L))ᵀ the conditions of Theorem 2
/// are linear.
class Proposition2 : public LmiDesignMethod {
 public:
  std::string name() const override { return "ferrante2019_proposition2"; }

  std::string summary() const override {
    return "gain L and intersample injection H together, by cancelling C L C";
  }

  const Theorem& theorem() const override { return *find_theorem("ferrante2019_theorem2"); }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return {
        {"lambda_t", "rate of convergence [1/s]", 0.01, std::nullopt},
        {"delta", "how fast the weight of the held innovation falls [1/s]", std::nullopt,
         SearchRange{0.1 / subject.T2, 30.0 / subject.T2, true}},
        {"gain_bound", "bound on the norm of L", 1000.0, std::nullopt},
    };
  }

  std::vector<Objective> objectives(const CertificateSubject& subject) const override {
    std::vector<Objective> all = {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay};
    if (subject.plant.N.cols() > 0) all.push_back(Objective::kMinGamma);
    return all;
  }

 protected:
  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective objective) const override {
    const PlantMatrices& plant = subject.plant;
    const Eigen::Index n = plant.states();
    const Eigen::Index m = plant.C().rows();
    const Eigen::Index n_w = plant.N.cols();
    const Eigen::Index n_s = plant.G.cols();
    const double lambda_t = parameters.at("lambda_t");
    const double delta = parameters.at("delta");
    const MatrixExpression A = plant.A();
    const MatrixExpression C = plant.C();

    LmiProgram program;
    const MatrixExpression P1 = program.symmetric("P1", n);
    const MatrixExpression P2 = program.symmetric("P2", m);
    const MatrixExpression J = program.matrix("J", n, m);
    const MatrixExpression Y = program.matrix("Y", m, m);
    program.require_positive("P1 > 0", P1);
    program.require_positive("P2 > 0", P2);
    MatrixExpression corner = He(P1 * A - J * C) + 2.0 * lambda_t * P1;
    corner = corner + Eigen::MatrixXd(plant.C_p.transpose() * plant.C_p);
    std::vector<MatrixExpression> columns;
    std::vector<std::vector<MatrixExpression>> rest;
    if (n_w > 0) {
      const bool minimizes = objective == Objective::kMinGamma;
      const MatrixExpression mu =
          minimizes || parameters.count("gamma") == 0
              ? program.squared("gamma")
              : MatrixExpression(parameters.at("gamma") * parameters.at("gamma"));
      if (minimizes) program.minimize(mu);
      columns.push_back(plant.N);
      rest.push_back({-(mu * identity(n_w))});
      if (n_s > 0) rest.back().push_back(zeros(n_w, n_s));
    }
    if (n_s > 0) {
      const double ell = *plant.lipschitz_constant;
      const MatrixExpression chi = program.scalar("chi");
      program.require_positive("chi > 0", chi);
      corner = corner +
               chi * MatrixExpression(Eigen::MatrixXd(ell * ell * plant.S.transpose() * plant.S));
      columns.push_back(plant.G);
      rest.push_back({-(chi * identity(n_s))});
    }
    for (const auto& [name, e] :
         {std::pair<const char*, double>{"(34), first", 1.0},
          std::pair<const char*, double>{"(34), second", std::exp(delta * subject.T2)}}) {
      std::vector<MatrixExpression> first = {
          corner, J + e * (transpose(A) * transpose(C) * P2 - transpose(C) * Y)};
      std::vector<MatrixExpression> second = {e * (He(Y) + (2.0 * lambda_t - delta) * P2)};
      for (const MatrixExpression& column : columns) {
        first.push_back(P1 * column);
        second.push_back(e * (P2 * C * column));
      }
      std::vector<std::vector<MatrixExpression>> rows = {first, second};
      rows.insert(rows.end(), rest.begin(), rest.end());
      program.require_negative(name, symmetric_blocks(rows));
    }
    // LᵀL <= k² I, since Jᵀ P1⁻¹ J <= q k² I and P1 >= q I. Without it L grows without bound.
    const double k = parameters.at("gain_bound");
    const MatrixExpression q = program.scalar("q");
    program.bound_above("q I <= P1", q * identity(n), P1);
    program.bound_above("norm of L", zeros(n + m, n + m),
                        symmetric_blocks({{P1, J}, {k * k * q * identity(m)}}));
    return program;
  }

  NamedMatrices gains(const CertificateSubject& subject, const Parameters&,
                      const NamedMatrices& solution) const override {
    const Eigen::MatrixXd L = solve_linear(solution.at("P1"), solution.at("J"));
    const Eigen::MatrixXd H =
        solve_linear(solution.at("P2"), solution.at("Y").transpose()) - subject.plant.C() * L;
    return {{"L", L}, {"H", H}};
  }
};

}  // namespace

const DesignMethod& ferrante2019_proposition2() {
  static const Proposition2 method;
  return method;
}

}  // namespace sampled_data_observers
