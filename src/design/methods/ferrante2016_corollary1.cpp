#include "methods.h"
#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/design/polytopic_embedding.h"
#include "sampled_plant.h"

namespace sampled_data_observers {
namespace {

/// ferrante2016, Corollary 1: with J = F L, (12) is linear in F, J, P and e^{Aτ}, so that the
/// vertices of a polytope around e^{Aτ} are enough. P of the solution is the proof for all τ.
class Corollary1 : public LmiDesignMethod {
 public:
  std::string name() const override { return "ferrante2016_corollary1"; }

  std::string summary() const override {
    return "constant gain L, by a polytope around e^(A tau); up to 2^n inequalities";
  }

  const Theorem& theorem() const override { return *find_theorem("ferrante2016_theorem1"); }

  std::vector<DesignParameter> parameters(const CertificateSubject&) const override {
    return {{"decay", "rate of convergence from sample to sample [1/s]; 0: (12) as printed", 0.0,
             std::nullopt}};
  }

  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay};
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    DesignCandidate none;
    if (parameters.at("decay") < 0.0) {
      none.message = "decay must not be negative";
    } else {
      none.message = undetectable_sampling(subject);
    }
    if (!none.message.empty()) return none;
    DesignCandidate candidate = solve(subject, parameters, objective);
    if (!candidate.is_verified() || candidate.margin > kLeastMargin) return candidate;
    none.message = on_the_edge(candidate.margin);
    return none;
  }

  LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                     Objective) const override {
    const Eigen::Index n = subject.plant.states();
    const MatrixExpression C = subject.plant.C();
    const Eigen::MatrixXd A =
        subject.plant.A() + parameters.at("decay") * Eigen::MatrixXd::Identity(n, n);
    LmiProgram program;
    const MatrixExpression P = program.symmetric("P", n);
    const MatrixExpression F = program.matrix("F", n, n);
    const MatrixExpression J = program.matrix("J", n, subject.plant.C().rows());
    for (const Eigen::MatrixXd& X : polytopic_embedding(A, subject.T1, subject.T2)) {
      program.require_negative(
          "(41)",
          symmetric_blocks(
              {{-He(F), F - J * C, transpose(MatrixExpression(X)) * P}, {-P, zeros(n, n)}, {-P}}));
    }
    program.bound_above("P <= I", P, identity(n));
    return program;
  }

 protected:
  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    return {{"L", solve_linear(solution.at("F"), solution.at("J"))}};
  }
};

}  // namespace

const DesignMethod& ferrante2016_corollary1() {
  static const Corollary1 method;
  return method;
}

}  // namespace sampled_data_observers
