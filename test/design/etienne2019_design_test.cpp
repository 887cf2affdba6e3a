// etienne2019: the DC drive of section 6, against numbers computed independently.
#include <gtest/gtest.h>

#include <cmath>

#include "design/certified.h"
#include "design/synthesis.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

const char* const kProposition1 = "etienne2019_proposition1";
const char* const kProposition2 = "etienne2019_proposition2";
const char* const kChannels = "etienne2019_proposition2_channels";

CertificateSubject dc_drive(double T2) {
  Eigen::MatrixXd A(3, 3);
  A << 0, 1, 0, 0, -3, 1, 0, -1, -1;
  CertificateSubject subject;
  subject.plant = linear_plant(A);
  subject.plant.modes.front().C = Eigen::MatrixXd::Identity(1, 3);
  subject.plant.G = Eigen::MatrixXd::Zero(3, 1);
  subject.plant.G(1, 0) = -2.0;
  subject.plant.S = Eigen::MatrixXd::Identity(1, 3);
  for (const double slope : {2.0, -2.0}) {
    Eigen::MatrixXd vertex = Eigen::MatrixXd::Zero(3, 3);
    vertex(1, 0) = slope;
    subject.plant.vertices.push_back(vertex);
  }
  subject.T1 = 0.1;
  subject.T2 = T2;
  return subject;
}

Eigen::MatrixXd printed_L() {
  Eigen::MatrixXd L(3, 1);
  L << -2.2, 0.16, 0.45;
  return L;
}

NamedMatrices printed(double alpha) {
  return {{"L", printed_L()}, {"alpha", scalar_matrix(alpha)}};
}

Design designed(const char* method, double T2, Objective objective, Parameters given) {
  DesignProblem problem;
  problem.subject = dc_drive(T2);
  problem.objective = objective;
  problem.given = std::move(given);
  SynthesisOptions options;
  options.jobs = 2;
  Design design = synthesize(*find_design_method(method), problem, options);
  EXPECT_TRUE(all_hold(check(design.certificate)));
  return design;
}

TEST(Etienne2019, Proposition1FindsAGainForThePapersRateAndInterval) {
  const Design design = designed(kProposition1, 0.4, Objective::kFeasible, {{"alpha", 1.0}});
  EXPECT_LT(norm2(design.certificate.values.at("L")), 20.0);
}

TEST(Etienne2019, ThePrintedGainSatisfiesProposition1ButNotForTwiceTheInterval) {
  EXPECT_TRUE(certified(kProposition1, dc_drive(0.4), printed(1.0)).is_verified());
  EXPECT_FALSE(certified(kProposition1, dc_drive(0.8), printed(1.0)).is_verified());
}

TEST(Etienne2019, WithTheOtherSignThePrintedGainProvesNothing) {
  NamedMatrices fixed = printed(1.0);
  fixed["L"] = -printed_L();
  EXPECT_FALSE(certified(kProposition1, dc_drive(0.4), fixed).is_verified());
}

TEST(Etienne2019, GammaOf2Point7HoldsForThePrintedGainAndIsLoose) {
  NamedMatrices fixed = printed(1.0);
  fixed["gamma"] = scalar_matrix(2.7);
  EXPECT_TRUE(certified(kProposition2, dc_drive(0.4), fixed).is_verified());

  const DesignCandidate best =
      certified(kProposition2, dc_drive(0.4), printed(1.0), Objective::kMinGamma);
  ASSERT_TRUE(best.is_verified()) << best.message;
  const double gamma = scalar_value(best.values, "gamma");
  EXPECT_LT(gamma, 1.35);
  fixed["gamma"] = scalar_matrix(0.99 * gamma / 1.001);
  EXPECT_FALSE(certified(kProposition2, dc_drive(0.4), fixed).is_verified());
}

/// The certified factor from the noise to the final error, which independent computations with
/// G_1 = G_2 for times in seconds put at 2.23 for the best rate; by a norm of L and Proposition 2
/// as printed it is 2.90 for the printed gain.
double noise_figure(const Certificate& certificate) {
  return certificate.theorem->guaranteed_figures(certificate.subject, certificate.values)
      .front()
      .value;
}

TEST(Etienne2019, NoiseThroughLGivesASmallerFinalErrorThanItsNorm) {
  NamedMatrices fixed = printed(1.0);
  fixed["noise_size"] = scalar_matrix(1.0);
  const DesignCandidate channels = certified(kChannels, dc_drive(0.4), fixed, Objective::kMinGamma);
  ASSERT_TRUE(channels.is_verified()) << channels.message;
  EXPECT_NEAR(noise_figure({find_theorem(kChannels), dc_drive(0.4), channels.values}), 2.324,
              0.005);

  const Design at_1 = designed(kProposition2, 0.4, Objective::kMinGamma, {{"alpha", 1.0}});
  EXPECT_EQ(at_1.certificate.theorem->name(), kChannels);
  // G_1 = G_2 for times in T2 gives better gains than for times in seconds, 2.358 and 2.221.
  EXPECT_NEAR(noise_figure(at_1.certificate), 2.252, 0.005);
  const Design best = designed(kProposition2, 0.4, Objective::kMinGamma, {});
  EXPECT_NEAR(noise_figure(best.certificate), 2.194, 0.005);
}

TEST(Etienne2019, TheFinalErrorDoesNotDependOnTheUnitOfTheNoise) {
  const Design of_1 = designed(kProposition2, 0.4, Objective::kMinGamma, {{"alpha", 1.0}});
  const Design of_10 =
      designed(kProposition2, 0.4, Objective::kMinGamma, {{"alpha", 1.0}, {"noise_size", 10.0}});
  EXPECT_NEAR(noise_figure(of_10.certificate), noise_figure(of_1.certificate), 0.01);
  EXPECT_NEAR(of_10.certificate.theorem->gain_figure(of_10.certificate.values).value,
              10.0 * noise_figure(of_10.certificate), 1e-9);
}

TEST(Etienne2019, ADisturbanceThatEntersInOneRowCostsLessThanOneOfAnyDirection) {
  CertificateSubject subject = dc_drive(0.4);
  subject.plant.N = Eigen::MatrixXd::Zero(3, 1);
  subject.plant.N(1, 0) = 1.0;
  NamedMatrices fixed = printed(1.0);
  const DesignCandidate any = certified(kProposition2, subject, fixed, Objective::kMinGamma);
  fixed["noise_size"] = scalar_matrix(1e-3);
  fixed["disturbance_size"] = scalar_matrix(1.0);
  const DesignCandidate channels = certified(kChannels, subject, fixed, Objective::kMinGamma);
  ASSERT_TRUE(any.is_verified() && channels.is_verified());
  const auto bound = [&](const char* theorem, const DesignCandidate& proof) {
    DrivenBound driven(
        find_theorem(theorem)->error_bound(subject, proof.values, assumptions(0.0, 0.0, 0.5)));
    for (int i = 0; i < 100; ++i) {
      driven.flow_to(0.4);
      driven.sample();
    }
    return driven.value();
  };
  EXPECT_LT(bound(kChannels, channels), 0.9 * bound(kProposition2, any));
}

TEST(Etienne2019, SizesOfNoiseAndDisturbanceMustBePositive) {
  NamedMatrices fixed = printed(1.0);
  fixed["noise_size"] = scalar_matrix(-1.0);
  EXPECT_FALSE(certified(kChannels, dc_drive(0.4), fixed, Objective::kMinGamma).is_verified());
}

TEST(Etienne2019, TheLargestIntervalAndTheLargestRateLieBeyondThePapers) {
  const Design longest = designed(kProposition1, 0.4, Objective::kMaxT2, {{"alpha", 1.0}});
  EXPECT_GT(longest.certificate.subject.T2, 0.55);
  const Design fastest = designed(kProposition1, 0.4, Objective::kMaxDecay, {});
  EXPECT_GT(scalar_value(fastest.certificate.values, "alpha"), 1.3);
}

TEST(Etienne2019, ANonlinearPlantNeedsVertices) {
  CertificateSubject subject = dc_drive(0.4);
  subject.plant.vertices.clear();
  EXPECT_THROW(find_theorem(kProposition1)->require_applicable(subject), std::invalid_argument);
}

class Etienne2019Bound : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Theorems, Etienne2019Bound, testing::Values(kProposition2, kChannels));

/// The error z with the slope of ψ and noise as bad as they may be, by small steps, beside its
/// bound.
TEST_P(Etienne2019Bound, HoldsAlongTheWorstOfManyErrorsAndConverges) {
  CertificateSubject subject = dc_drive(0.4);
  subject.plant.N = Eigen::MatrixXd::Identity(3, 3);
  NamedMatrices fixed = printed(1.0);
  if (GetParam() == kChannels) {
    fixed["noise_size"] = scalar_matrix(0.1);
    fixed["disturbance_size"] = scalar_matrix(0.05);
  }
  const DesignCandidate proof = certified(GetParam(), subject, fixed, Objective::kMinGamma);
  ASSERT_TRUE(proof.is_verified()) << proof.message;
  DrivenBound bound(
      find_theorem(GetParam())->error_bound(subject, proof.values, assumptions(2.0, 0.1, 0.05)));

  constexpr double kStep = 1e-3;
  constexpr int kSteps = 20000;
  Eigen::Vector3d z(2.0, 0.0, 0.0);
  Eigen::Vector3d held = Eigen::Vector3d::Zero();
  int since = 0;
  double steady = 0.0;
  double largest = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    // 1.2 s without samples in the middle.
    if (i % 400 == 250 && (i < 10000 || i > 10800)) {
      held = printed_L() * (z(0) + 0.1 * std::cos(i));
      bound.sample();
      since = 0;
    }
    const Eigen::MatrixXd R =
        subject.plant.A() + subject.plant.vertices[static_cast<std::size_t>(i / 700 % 2)];
    const Eigen::Vector3d w = 0.05 * Eigen::Vector3d(std::sin(i), std::cos(i), 0.0);
    z += kStep * (R * z + held + w);
    bound.flow_to(++since * kStep);
    ASSERT_LE(z.norm(), bound.value()) << "at " << i * kStep;
    if (i > 9000 && i <= 10000) steady = std::max(steady, bound.value());
    if (i > 10000) largest = std::max(largest, bound.value());
  }
  EXPECT_GT(largest, 1.2 * steady);
  EXPECT_LT(largest, 100.0 * steady);
  EXPECT_LT(bound.value(), 2.0);
}

TEST(Etienne2019, Proposition1BoundsNothingUnderNoise) {
  const CertificateSubject subject = dc_drive(0.4);
  const DesignCandidate proof = certified(kProposition1, subject, printed(1.0));
  ASSERT_TRUE(proof.is_verified());
  const Theorem& theorem = *find_theorem(kProposition1);
  EXPECT_THROW(theorem.error_bound(subject, proof.values, assumptions(1.0, 0.1, 0.0)),
               std::invalid_argument);
  DrivenBound bound(theorem.error_bound(subject, proof.values, assumptions(1.0, 0.0, 0.0)));
  bound.sample();
  const double first = bound.value();
  for (int i = 0; i < 10; ++i) {
    bound.flow_to(0.4);
    bound.sample();
  }
  EXPECT_NEAR(bound.value(), first * std::exp(-0.5 * 4.0), 1e-9);
}

}  // namespace
}  // namespace sampled_data_observers
