// Ball arithmetic on conditions whose truth is known in closed form, on those of the papers'
// examples, and on designs.
#include "sampled_data_observers/design/rigorous_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/config/design_config.h"
#include "sampled_data_observers/design/synthesis.h"

namespace sampled_data_observers {
namespace {

const double kPi = std::acos(-1.0);

Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols, const std::vector<double>& entries) {
  Eigen::MatrixXd result(rows, cols);
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    result(i / cols, i % cols) = entries[static_cast<std::size_t>(i)];
  }
  return result;
}

/// cos τ, as an entry of the rotation e^{[0 1; −1 0] τ}.
MatrixExpression cosine() {
  const MatrixExpression first = matrix(1, 2, {1, 0});
  return first * exponential(matrix(2, 2, {0, 1, -1, 0}) * time_tau()) * transpose(first);
}

ConditionProof prove_over(const MatrixExpression& expression, double low, double high,
                          const NamedMatrices& values = {}) {
  return prove({{"condition", expression, Condition::Range{low, high}}}, values).front();
}

ConditionProof prove_constant(const MatrixExpression& expression,
                              const NamedMatrices& values = {}) {
  return prove({{"condition", expression, std::nullopt}}, values).front();
}

TEST(RigorousCheck, ProvesABoundOnTheCosineOverManyTurns) {
  const ConditionProof proof = prove_over(cosine() + 1.001, 0.0, 50.0);
  EXPECT_EQ(proof.status, ProofStatus::kProved) << proof.reason;
  EXPECT_FALSE(proof.tau);
}

TEST(RigorousCheck, DisprovesWhereTheFloatingPointCheckFindsNothing) {
  // The grid of the floating-point check has a point at π, where the condition holds, and two
  // around 3π, where it is violated on an interval of 5e-4 s between them.
  const double step = 2.0 * kPi / 40.5;
  const double low = kPi - 10.0 * step;
  const double high = low + 64.0 * step;
  const MatrixExpression expression = cosine() + 1.0 + 1e-8 * (2.0 * kPi - time_tau());
  const std::vector<Condition> conditions = {
      {"condition", expression, Condition::Range{low, high}}};
  ASSERT_TRUE(all_hold(check(conditions, {})));

  const ConditionProof proof = prove(conditions, {}).front();
  EXPECT_EQ(proof.status, ProofStatus::kDisproved) << proof.reason;
  ASSERT_TRUE(proof.tau);
  EXPECT_NEAR(*proof.tau, 3.0 * kPi, 3e-4);
  EXPECT_LT(std::cos(*proof.tau) + 1.0 + 1e-8 * (2.0 * kPi - *proof.tau), 0.0);
  EXPECT_LT(proof.value, 0.0);
}

TEST(RigorousCheck, LeavesUndecidedWhatIsSingularAtAPoint) {
  const ConditionProof proof = prove_over(cosine() + 1.0, 0.0, 4.0);
  EXPECT_EQ(proof.status, ProofStatus::kUndecided);
  ASSERT_TRUE(proof.tau);
  EXPECT_NEAR(*proof.tau, kPi, 1e-6);
  EXPECT_NE(proof.reason.find("too close to zero"), std::string::npos) << proof.reason;
}

TEST(RigorousCheck, LeavesUndecidedWhatIsSingularEverywhere) {
  const MatrixExpression rotation = exponential(matrix(2, 2, {0, 1, -1, 0}) * time_tau());
  const ConditionProof proof =
      prove_over(transpose(rotation) * matrix(2, 2, {1, 1, 1, 1}) * rotation, 0.0, 1.0);
  EXPECT_EQ(proof.status, ProofStatus::kUndecided);
}

TEST(RigorousCheck, IsAboutTheEndsOfTheInterval) {
  EXPECT_EQ(prove_over(2.0 - time_tau(), 0.0, 1.9).status, ProofStatus::kProved);
  EXPECT_EQ(prove_over(2.0 - time_tau(), 0.0, 2.0).status, ProofStatus::kUndecided);
  EXPECT_EQ(prove_over(2.0 - time_tau(), 0.0, 2.1).status, ProofStatus::kDisproved);
  EXPECT_EQ(prove_over(time_tau(), 0.1, 0.1).status, ProofStatus::kProved);
}

TEST(RigorousCheck, EnclosesInversesOverTau) {
  // (1 + τ²)⁻¹ >= 1/10 on [0, 3], by way of [1 τ; −τ 1]⁻¹.
  const MatrixExpression corner = matrix(1, 2, {1, 0});
  const MatrixExpression inverted = inverse(identity(2) + time_tau() * matrix(2, 2, {0, 1, -1, 0}));
  const MatrixExpression value = corner * inverted * transpose(corner);
  EXPECT_EQ(prove_over(value - 0.0999, 0.0, 3.0).status, ProofStatus::kProved);
  const ConditionProof proof = prove_over(value - 0.1001, 0.0, 3.0);
  EXPECT_EQ(proof.status, ProofStatus::kDisproved);
  EXPECT_NEAR(proof.value, -1e-4, 1e-9);
}

TEST(RigorousCheck, EnclosesExponentialsOfSumsOverTau) {
  // Not of the form f(τ) M.
  const MatrixExpression A = matrix(2, 2, {0, 1, 0, 0});
  const MatrixExpression B = matrix(2, 2, {0, 0, 1, 0});
  const MatrixExpression trace_like = matrix(1, 2, {1, 0});
  // The first entry of e^{τ A + B} is cosh √τ.
  const MatrixExpression value =
      trace_like * exponential(time_tau() * A + B) * transpose(trace_like);
  const double largest = std::cosh(1.0);
  EXPECT_EQ(prove_over(largest + 1e-2 - value, 0.0, 1.0).status, ProofStatus::kProved);
  EXPECT_EQ(prove_over(largest - 1e-2 - value, 0.0, 1.0).status, ProofStatus::kDisproved);
}

TEST(RigorousCheck, TakesNumbersAsAllThatRoundToThem) {
  // 0.1 + 0.2 > 0.3 for the doubles, but not for the decimals.
  const NamedMatrices values = {
      {"a", scalar_matrix(0.1)}, {"b", scalar_matrix(0.2)}, {"c", scalar_matrix(0.3)}};
  EXPECT_EQ(prove_constant(symbol("a") + symbol("b") - symbol("c"), values).status,
            ProofStatus::kUndecided);
  // Whole numbers are themselves.
  EXPECT_EQ(prove_constant(MatrixExpression(3.0) - 2.0 - (1.0 - std::ldexp(1.0, -70))).status,
            ProofStatus::kUndecided);
  EXPECT_EQ(prove_constant(1e30 * MatrixExpression(1.0) + 1.0 - 1e30).status, ProofStatus::kProved);
}

TEST(RigorousCheck, DoesNotProveWhatIsNotFinite) {
  const NamedMatrices values = {{"P", scalar_matrix(std::nan(""))}};
  EXPECT_EQ(prove_constant(symbol("P"), values).status, ProofStatus::kUndecided);
  EXPECT_EQ(prove_over(time_tau() * symbol("P"), 0.0, 1.0, values).status, ProofStatus::kUndecided);
  EXPECT_EQ(prove_constant(inverse(matrix(2, 2, {1, 1, 1, 1}))).status, ProofStatus::kUndecided);
}

/// Ξ_P(τ) > 0, sferlazza2019 (21), of the aircraft (66).
Condition aircraft_condition(double T1, double T2) {
  const MatrixExpression A = matrix(3, 3, {-0.02, -1.4, 9.8, -0.01, -0.4, 0, 0, 1, 0});
  const MatrixExpression complement = matrix(3, 2, {1, 0, 0, 1, -1, 0});
  const MatrixExpression P = symbol("P", 3, 3);
  const MatrixExpression back = exponential(-(time_tau() * A)) * complement;
  return {"Xi_P(tau) > 0",
          symmetric_blocks({{transpose(back) * P * back, transpose(complement) * P}, {P}}),
          Condition::Range{T1, T2}};
}

TEST(RigorousCheck, ProvesThePrintedMatrixOfSferlazza2019) {
  // (67)
  const NamedMatrices printed = {
      {"P",
       matrix(3, 3, {0.8334, -0.0041, 0.8333, -0.0041, 2.0116, -0.0359, 0.8333, -0.0359, 0.8341})}};
  const ConditionProof proof = prove({aircraft_condition(1, 3)}, printed).front();
  EXPECT_EQ(proof.status, ProofStatus::kProved) << proof.reason;
  // Where a turn of the short period makes the plant unobservable from two samples no P will do.
  const ConditionProof too_long = prove({aircraft_condition(8.5, 8.6)}, printed).front();
  EXPECT_EQ(too_long.status, ProofStatus::kDisproved);
}

TEST(RigorousCheck, ProvesTheSpreadOutIntervalOfSferlazza2019) {
  const NamedMatrices shipped = {
      {"P", matrix(3, 3,
                   {0.50702492244326325, 0.16007158892513734, 0.46744347768574857,
                    0.16007158892513734, 0.94621739393045601, -0.15598834576597512,
                    0.46744347768574857, -0.15598834576597512, 0.54696841322230516})}};
  const ConditionProof proof = prove({aircraft_condition(4, 8)}, shipped).front();
  EXPECT_EQ(proof.status, ProofStatus::kProved) << proof.reason;
}

TEST(RigorousCheck, DecidesThePrintedGainOfFerrante2016) {
  // Example 2, with the sensor's bias as fifth state.
  const Eigen::MatrixXd A =
      matrix(5, 5, {0, 0, 1, 0, 0, 0, 0, 0, 1, 0, -2, 1, -1, 0, 0, 2, -2, 0, -2, 0, 0, 0, 0, 0, 0});
  const Eigen::MatrixXd M = matrix(1, 5, {1, 0, 0, 0, 1});
  Eigen::MatrixXd L = matrix(5, 1, {0.77524, 0.18123, -0.12123, -0.17406, 0.22469});
  const MatrixExpression P = symbol("P", 5, 5);
  const MatrixExpression step =
      exponential(time_tau() * MatrixExpression(A)) * (identity(5) - symbol("L", 5, 1) * M);
  const Condition condition = {"(12)", P - transpose(step) * P * step, Condition::Range{0.2, 3.0}};
  LmiProgram program;
  program.symmetric("P", 5);
  program.fix("L", L);
  program.require_positive("P > 0", P);
  program.require(condition, 25);
  program.bound_above("P <= I", P, identity(5));
  const LmiSolution solution = solve_lmi(program);
  ASSERT_TRUE(solution.satisfies_all()) << solution.message;
  NamedMatrices values = {{"P", solution.values.at("P")}, {"L", L}};
  const ConditionProof proof = prove({condition}, values).front();
  EXPECT_EQ(proof.status, ProofStatus::kProved) << proof.reason;

  values["L"](0, 0) += 1.0;
  EXPECT_EQ(prove({condition}, values).front().status, ProofStatus::kDisproved);
}

CertificateSubject example(const std::string& name, double T2) {
  const std::string file = std::string(SDO_SOURCE_DIR) + "/config/examples/" + name + "/plant.yaml";
  CertificateSubject subject = read_design_config({file}, {}).subject;
  subject.T1 = T2 / 2.0;
  subject.T2 = T2;
  return subject;
}

void expect_proved_until_broken(const CertificateSubject& subject, const Parameters& given,
                                const std::string& method) {
  DesignProblem problem;
  problem.subject = subject;
  problem.given = given;
  problem.objective = Objective::kMinGamma;
  SynthesisOptions options;
  options.jobs = 2;
  const Certificate certificate =
      synthesize(*find_design_method(method), problem, options).certificate;
  const std::vector<Condition> conditions = certificate.theorem->conditions(certificate.subject);
  for (const ConditionProof& proof : prove(conditions, certificate.values)) {
    EXPECT_EQ(proof.status, ProofStatus::kProved) << proof.name << ": " << proof.reason;
  }
  for (const NamedShape& shape : certificate.theorem->gains(certificate.subject)) {
    NamedMatrices broken = certificate.values;
    broken.at(shape.name)(0, 0) += 1.0 + std::abs(broken.at(shape.name)(0, 0));
    const auto proofs = prove(conditions, broken);
    EXPECT_TRUE(std::any_of(proofs.begin(), proofs.end(), [](const ConditionProof& proof) {
      return proof.status == ProofStatus::kDisproved && proof.value < 0.0;
    })) << shape.name;
  }
}

TEST(RigorousCheck, ProvesADesignForTheOscillatorUntilAGainIsChanged) {
  CertificateSubject subject = example("ferrante2019_oscillator", 0.41);
  subject.plant.N = matrix(2, 1, {1, 0});
  subject.plant.C_p = Eigen::MatrixXd::Identity(2, 2);
  expect_proved_until_broken(subject, {{"lambda_t", 0.05}, {"delta", 3.0}},
                             "ferrante2019_proposition2");
}

TEST(RigorousCheck, ProvesADesignForTheFlexibleLinkUntilAGainIsChanged) {
  CertificateSubject subject = example("ferrante2019_flexible_link", 0.1);
  subject.plant.N = matrix(4, 1, {0, 1, 0, 0});
  subject.plant.C_p = matrix(1, 4, {0, 0, 1, 0});
  expect_proved_until_broken(subject, {{"lambda_t", 0.01}, {"delta", 10.0}},
                             "ferrante2019_proposition2");
}

}  // namespace
}  // namespace sampled_data_observers
