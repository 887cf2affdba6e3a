// Nothing counts as a design that is not proved, and no search answers with less than was asked.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "design/attempts.h"
#include "design/rigorous_check.h"
#include "ferrante2019_examples.h"
#include "linear_algebra/matrix_functions.h"
#include "paper_plants.h"

namespace sampled_data_observers::test {
namespace {

/// A pendulum of 1 Hz with an encoder, and a gyro with a bias: samples 1 s apart show two modes as
/// one.
CertificateSubject pendulum(double T1, double T2) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = 1.0;
  A(1, 0) = -std::pow(2.0 * std::acos(-1.0), 2);
  Eigen::MatrixXd C(2, 3);
  C << 1, 0, 0,  //
      0, 1, 1;
  return linear_subject(A, C, T1, T2);
}

void expect_proved(const Design& design) {
  const auto proofs = prove(design.certificate.theorem->conditions(design.certificate.subject),
                            design.certificate.values);
  EXPECT_EQ(design.proved_conditions, proofs.size());
  for (const ConditionProof& proof : proofs) {
    EXPECT_EQ(proof.status, ProofStatus::kProved) << design.method << ": " << proof.name;
  }
}

TEST(ProvedDesigns, OfTheOscillatorReachTheLongestTimeThatIsTrue) {
  const Design design = design_by("ferrante2019_proposition2", oscillator(0.41),
                                  {{"lambda_t", 0.05}}, Objective::kMaxT2);
  expect_proved(design);
  EXPECT_GT(design.certificate.subject.T2, 0.434);
  EXPECT_LT(design.certificate.subject.T2, 0.447);
  EXPECT_LT(scalar_value(design.certificate.values, "gamma"), 1e5);
}

TEST(ProvedDesigns, NeverHoldForTimesAtWhichTwoModesLookTheSame) {
  const std::vector<std::pair<const char*, Parameters>> methods = {
      {"ferrante2016_corollary1", {}},
      {"sferlazza2019_algorithm1", {}},
      {"ferrante2019_proposition2", {{"delta", 5.0}}},
      {"etienne2019_proposition1", {}}};
  for (const auto& [method, given] : methods) {
    const Design design = design_by(method, pendulum(0.01, 0.1), given, Objective::kMaxT2);
    expect_proved(design);
    EXPECT_LT(design.certificate.subject.T2, 1.0) << method;
    EXPECT_GE(design.certificate.subject.T2, 0.1) << method;
    EXPECT_EQ(design.certificate.subject.T1, 0.01) << method;
    EXPECT_NE(refusal(method, pendulum(0.9, 1.1)).find("samples 1 s apart"), std::string::npos)
        << method;
  }
}

TEST(ProvedDesigns, SayThatThereIsNoneForATimeThatWasAskedFor) {
  const std::string message =
      refusal("ferrante2016_corollary1", pendulum(0.01, 3.2), {}, Objective::kMaxT2);
  EXPECT_NE(message.find("no design for T2 = 3.2 as asked for"), std::string::npos) << message;
  EXPECT_NE(message.find("the largest T2 for which it found one is 0.99"), std::string::npos)
      << message;
}

TEST(ProvedDesigns, DoNotLowerT1) {
  const std::string message =
      refusal("ferrante2016_corollary1", pendulum(1.5, 1.9), {}, Objective::kMaxT2);
  EXPECT_EQ(message, "");
  const std::string longer =
      refusal("ferrante2016_corollary1", pendulum(0.9, 1.9), {}, Objective::kMaxT2);
  EXPECT_NE(longer.find("no design for T2 = 1.9"), std::string::npos) << longer;
}

TEST(ProvedDesigns, SayThatThereIsNoneForARateThatWasAskedFor) {
  const std::string message = refusal("ferrante2016_corollary1", pendulum(0.01, 0.1),
                                      {{"decay", 500.0}}, Objective::kMaxDecay);
  EXPECT_NE(message.find("no design for decay = 500 as asked for"), std::string::npos) << message;
}

/// Claims that gains are verified.
class Claims : public DesignMethod {
 public:
  Claims(const Theorem& theorem, NamedMatrices values)
      : theorem_(theorem), values_(std::move(values)) {}

  std::string name() const override { return "claims"; }
  std::string summary() const override { return "claims"; }
  const Theorem& theorem() const override { return theorem_; }
  std::vector<DesignParameter> parameters(const CertificateSubject&) const override { return {}; }
  std::vector<std::string> bounded_gains(const CertificateSubject&) const override { return {"L"}; }
  std::vector<Objective> objectives(const CertificateSubject&) const override {
    return {Objective::kFeasible};
  }
  DesignCandidate attempt(const CertificateSubject&, const Parameters&, Objective) const override {
    DesignCandidate candidate;
    candidate.values = values_;
    candidate.margin = 1.0;
    return candidate;
  }

 private:
  const Theorem& theorem_;
  NamedMatrices values_;
};

DesignCandidate claimed(double L, double gain_bound) {
  // x' = x, sampled 1 s apart: any L from 1 - 1/e to 1 + 1/e will do.
  const Claims method(
      *find_theorem("ferrante2016_theorem1"),
      {{"L", scalar_matrix(L)}, {"P", scalar_matrix(1.0)}, {"decay", scalar_matrix(0.0)}});
  return proved_attempt(method, linear_subject(scalar_matrix(1.0), scalar_matrix(1.0), 1.0, 1.0),
                        {{"gain_bound", gain_bound}}, Objective::kFeasible, GainBound::kGiven);
}

TEST(ProvedAttempts, AcceptWhatBallArithmeticProves) {
  const DesignCandidate candidate = claimed(0.7, 1.0);
  EXPECT_TRUE(candidate.is_verified()) << candidate.message;
  EXPECT_EQ(candidate.proved_conditions,
            find_theorem("ferrante2016_theorem1")
                ->conditions(linear_subject(scalar_matrix(1.0), scalar_matrix(1.0), 1.0, 1.0))
                .size());
}

TEST(ProvedAttempts, RefuseWhatItDoesNotProve) {
  const DesignCandidate candidate = claimed(0.6, 1.0);
  EXPECT_FALSE(candidate.is_verified());
  EXPECT_EQ(candidate.proved_conditions, 0U);
  EXPECT_NE(candidate.message.find("ferrante2016 (12)"), std::string::npos) << candidate.message;
  // At the edge, floating point may say what it likes.
  for (const double rounding : {-1e-15, -1e-16, 0.0, 1e-17}) {
    EXPECT_FALSE(claimed(1.0 - std::exp(-1.0) + rounding, 1.0).is_verified()) << rounding;
  }
}

TEST(ProvedAttempts, RefuseGainsBeyondTheirBound) {
  EXPECT_TRUE(claimed(0.7, 0.7).is_verified());
  const DesignCandidate candidate = claimed(0.7, 0.7 * (1.0 - 1e-8));
  EXPECT_FALSE(candidate.is_verified());
  EXPECT_NE(candidate.message.find("gain_bound"), std::string::npos) << candidate.message;
}

TEST(WhyUnsolved, TellsInfeasibleFromFailed) {
  LmiSolution solution;
  solution.status = SolverStatus::kInfeasible;
  EXPECT_EQ(why_unsolved(solution), "has no solution by the solver's account");
  for (const SolverStatus status :
       {SolverStatus::kInaccurate, SolverStatus::kFailed, SolverStatus::kTimedOut}) {
    solution.status = status;
    EXPECT_NE(why_unsolved(solution).find("does not tell"), std::string::npos);
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
