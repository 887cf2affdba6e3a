// Ball arithmetic on conditions whose truth is known in closed form, on those of the papers'
// examples, and on designs.
#include "design/rigorous_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "config/design_config.h"
#include "linear_algebra/matrix_functions.h"
#include "paper_plants.h"

namespace sampled_data_observers::test {
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

TEST(RigorousCheck, DisprovesBetweenThePointsThatAreLookedAt) {
  // The grid of the floating-point check has a point at π, where the condition holds, and two
  // around 3π, where it is violated on an interval of 5e-4 s between them.
  const double step = 2.0 * kPi / 40.5;
  const double low = kPi - 10.0 * step;
  const double high = low + 64.0 * step;
  const MatrixExpression expression = cosine() + 1.0 + 1e-8 * (2.0 * kPi - time_tau());
  const std::vector<Condition> conditions = {
      {"condition", expression, Condition::Range{low, high}}};
  // It looks there again, since it can't enclose the condition.
  const ConditionCheck in_floating_point = check(conditions, {}).front();
  EXPECT_FALSE(in_floating_point.holds());
  EXPECT_NEAR(*in_floating_point.tau, 3.0 * kPi, 3e-4);

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

/// 3, and the double below it: apart by twice what rounding may hide of each.
TEST(RigorousCheck, TakesWholeNumbersForRoundedOnesWhereUnitsAreNotThoseOfAFile) {
  const std::vector<Condition> conditions = {
      {"apart", symbol("x", 1, 1) - std::nextafter(3.0, 0.0), std::nullopt}};
  const NamedMatrices values = {{"x", scalar_matrix(3.0)}};
  EXPECT_EQ(first_unproved(prove(conditions, values, ProofOptions())), "");
  ProofOptions options;
  options.rounded = RoundedNumbers::kAllButZero;
  EXPECT_EQ(prove(conditions, values, options).front().status, ProofStatus::kUndecided);
}

TEST(RigorousCheck, SaysWhetherTheTimeOrTheMatrixIsToBlame) {
  const std::vector<Condition> conditions = {
      {"first", cosine() + 1.001, Condition::Range{0.0, 50.0}}, {"second", 1.0, std::nullopt}};
  double share = 0.0;
  ProofOptions options;
  options.on_progress = [&](double done) {
    EXPECT_GE(done, share);
    share = done;
  };
  EXPECT_EQ(first_unproved(prove(conditions, {}, options)), "");
  EXPECT_EQ(share, 1.0);

  options.time_limit = 0.0;
  options.on_progress = nullptr;
  const std::vector<ConditionProof> proofs = prove(conditions, {}, options);
  EXPECT_EQ(proofs[0].status, ProofStatus::kUndecided);
  EXPECT_EQ(proofs[1].status, ProofStatus::kProved);
  const std::string reason = first_unproved(proofs);
  EXPECT_EQ(reason.rfind("first: ", 0), 0u) << reason;
  EXPECT_NE(reason.find("time limit of 0 s"), std::string::npos) << reason;
  EXPECT_EQ(reason.find("too close"), std::string::npos) << reason;
}

TEST(RigorousCheck, DoesNotDependOnUnits) {
  // e^{A τ} of a fast and a slow mode, in units that are 1e12 apart.
  const Eigen::MatrixXd D = Eigen::Vector2d(1e6, 1e-6).asDiagonal();
  const Eigen::MatrixXd A = matrix(2, 2, {-1, 1, -100, -100});
  const auto status = [&](const MatrixExpression& scale, double bound) {
    const MatrixExpression flow = exponential(time_tau() * A);
    const MatrixExpression F = bound * identity(2) - transpose(flow) * flow;
    return prove_over(transpose(scale) * F * scale, 0.0, 1.0).status;
  };
  for (const double bound : {30.0, 0.5}) {
    EXPECT_EQ(status(D, bound), status(identity(2), bound)) << bound;
    EXPECT_NE(status(D, bound), ProofStatus::kUndecided) << bound;
  }
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

std::vector<ConditionProof> prove_theorem(const char* theorem, const CertificateSubject& subject,
                                          const NamedMatrices& values) {
  return prove(find_theorem(theorem)->conditions(subject), values);
}

void expect_proved(const std::vector<ConditionProof>& proofs) {
  for (const ConditionProof& proof : proofs) {
    EXPECT_EQ(proof.status, ProofStatus::kProved) << proof.name << ": " << proof.reason;
    // Few intervals are enough: less than 0.1 s.
    EXPECT_LT(proof.intervals, 300u) << proof.name;
  }
}

bool is_disproved(const std::vector<ConditionProof>& proofs) {
  return std::any_of(proofs.begin(), proofs.end(), [](const ConditionProof& proof) {
    return proof.status == ProofStatus::kDisproved && proof.value < 0.0;
  });
}

/// P of sferlazza2019 by its upper triangle, row by row.
NamedMatrices aircraft_values(const std::vector<double>& p) {
  return {{"P", matrix(3, 3, {p[0], p[1], p[2], p[1], p[3], p[4], p[2], p[4], p[5]})},
          {"lambda", scalar_matrix(0.0)}};
}

TEST(RigorousCheck, ProvesThePrintedMatrixOfSferlazza2019For1To3Seconds) {
  const NamedMatrices printed =
      aircraft_values({0.8334, -0.0041, 0.8333, 2.0116, -0.0359, 0.8341});  // (67)
  expect_proved(prove_theorem("sferlazza2019_theorem2", aircraft(1.0, 3.0), printed));
  // From samples 8.541 s apart the plant is not observable.
  EXPECT_TRUE(is_disproved(prove_theorem("sferlazza2019_theorem2", aircraft(8.5, 8.6), printed)));
}

TEST(RigorousCheck, ProvesAFastMotorOverLongTimes) {
  // Flown back over 1 s, the speed grows by e^50.
  const CertificateSubject motor =
      linear_subject(matrix(2, 2, {0, 1, 0, -50}), matrix(1, 2, {1, 0}), 0.05, 1.0);
  for (const auto& P : {matrix(2, 2, {1, 0, 0, 1}), matrix(2, 2, {1, 0.02, 0.02, 0.001})}) {
    expect_proved(
        prove_theorem("sferlazza2019_theorem2", motor, {{"P", P}, {"lambda", scalar_matrix(0.0)}}));
  }
  const NamedMatrices values = proof_for_gains(
      "ferrante2016_theorem1", motor, {{"L", matrix(2, 1, {1, 0})}, {"decay", scalar_matrix(0.0)}});
  ASSERT_FALSE(values.empty());
  expect_proved(prove_theorem("ferrante2016_theorem1", motor, values));
}

TEST(RigorousCheck, DisprovesThePrintedMatrixOfSferlazza2019For4To8Seconds) {
  const NamedMatrices printed =
      aircraft_values({0.9573, -0.0031, 0.9571, 2.2754, -0.0122, 0.9573});  // (68)
  const auto proofs = prove_theorem("sferlazza2019_theorem2", aircraft(4.0, 8.0), printed);
  EXPECT_TRUE(is_disproved(proofs));
  EXPECT_NEAR(proofs.back().value, -0.065, 0.001);
}

TEST(RigorousCheck, ProvesThePrintedGainOfFerrante2016) {
  NamedMatrices fixed = {{"L", matrix(5, 1, {0.77524, 0.18123, -0.12123, -0.17406, 0.22469})},
                         {"decay", scalar_matrix(0.0)}};
  const CertificateSubject subject = mass_spring(0.2, 3.0);
  const NamedMatrices values = proof_for_gains("ferrante2016_theorem1", subject, fixed);
  ASSERT_FALSE(values.empty());
  expect_proved(prove_theorem("ferrante2016_theorem1", subject, values));
}

struct DesignCase {
  const char* method;
  CertificateSubject subject;
  Parameters given;
  Objective objective;
};

CertificateSubject example(const std::string& name, double T2, const Eigen::MatrixXd& N,
                           const Eigen::MatrixXd& C_p) {
  const std::string file = std::string(SDO_SOURCE_DIR) + "/config/examples/" + name + "/plant.yaml";
  CertificateSubject subject = read_design_config({file}, {}).subject;
  subject.T1 = T2 / 2.0;
  subject.T2 = T2;
  subject.plant.N = N;
  subject.plant.C_p = C_p;
  return subject;
}

TEST(RigorousCheck, ProvesDesignsUntilAGainIsChanged) {
  const std::vector<DesignCase> cases = {
      {"ferrante2019_proposition2",
       example("ferrante2019_oscillator", 0.41, matrix(2, 1, {1, 0}),
               Eigen::MatrixXd::Identity(2, 2)),
       {{"lambda_t", 0.05}, {"delta", 3.0}},
       Objective::kMinGamma},
      {"ferrante2019_proposition2",
       example("ferrante2019_flexible_link", 0.1, matrix(4, 1, {0, 1, 0, 0}),
               matrix(1, 4, {0, 0, 1, 0})),
       {{"lambda_t", 0.01}, {"delta", 10.0}},
       Objective::kMinGamma},
      {"ferrante2016_corollary1", mass_spring(0.2, 3.0), {}, Objective::kFeasible},
      {"sferlazza2019_algorithm1", aircraft(1.0, 3.0), {}, Objective::kFeasible},
      {"sferlazza2019_algorithm1", aircraft(4.0, 8.0), {}, Objective::kFeasible},
  };
  for (const DesignCase& one : cases) {
    SCOPED_TRACE(one.method);
    const Certificate certificate =
        design_by(one.method, one.subject, one.given, one.objective).certificate;
    const std::vector<Condition> conditions = certificate.theorem->conditions(certificate.subject);
    expect_proved(prove(conditions, certificate.values));
    const NamedShape gain = certificate.theorem->gains(certificate.subject).front();
    NamedMatrices broken = certificate.values;
    broken.at(gain.name)(0, 0) -= 2.0 * norm2(broken.at(gain.name));
    EXPECT_TRUE(is_disproved(prove(conditions, broken))) << gain.name;
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
