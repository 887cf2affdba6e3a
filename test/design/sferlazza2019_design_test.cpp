// sferlazza2019: the aircraft (66), the design by Algorithm 1, and the bound that (21) gives.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "paper_plants.h"
#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/design/sferlazza2019_verification.h"
#include "sampled_data_observers/observer/time_varying_gain.h"

namespace sampled_data_observers::test {
namespace {

const char* const kMethod = "sferlazza2019_algorithm1";
const Theorem& theorem() { return *find_theorem("sferlazza2019_theorem2"); }

NamedMatrices with_P(const std::vector<double>& upper, double lambda = 0.0) {
  Eigen::MatrixXd P(3, 3);
  P << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4], upper[5];
  return {{"P", P}, {"lambda", scalar_matrix(lambda)}};
}
/// (67) and (68)
const NamedMatrices kPrinted_1_3 = with_P({0.8334, -0.0041, 0.8333, 2.0116, -0.0359, 0.8341});
const NamedMatrices kPrinted_4_8 = with_P({0.9573, -0.0031, 0.9571, 2.2754, -0.0122, 0.9573});

double margin_of(const NamedMatrices& values, double T1, double T2) {
  return check(theorem().conditions(aircraft(T1, T2)), values, 2001).back().min_eigenvalue;
}

IntervalVerification verified(const NamedMatrices& values, double T1, double T2) {
  const PlantMatrices plant = aircraft(T1, T2).plant;
  return verify_between(plant.A(), null_space(plant.C()), values.at("P"), T1, T2);
}

TEST(Sferlazza2019Aircraft, HasThePrintedPWhereItHoldsAndWhereNot) {
  EXPECT_GT(margin_of(kPrinted_1_3, 1.0, 3.0), 0.0);
  EXPECT_TRUE(verified(kPrinted_1_3, 1.0, 3.0).holds);
  EXPECT_NEAR(margin_of(kPrinted_4_8, 4.0, 8.0), -0.065, 0.001);
  EXPECT_FALSE(verified(kPrinted_4_8, 4.0, 8.0).holds);
}

TEST(Sferlazza2019Aircraft, IsDesignedForInOneIterationFor1To3Seconds) {
  const Design design = design_by(kMethod, aircraft(1.0, 3.0));
  EXPECT_EQ(design.solver, "CSDP, in 1 iteration");
  EXPECT_TRUE(all_hold(check(design.certificate)));
  EXPECT_TRUE(verified(design.certificate.values, 1.0, 3.0).holds);
}

TEST(Sferlazza2019Aircraft, IsDesignedForFor3To4SecondsAgainstThePaper) {
  const Design design = design_by(kMethod, aircraft(3.0, 4.0), {{"lambda", 0.7}});
  EXPECT_TRUE(verified(design.certificate.values, 3.0, 4.0).holds);
  EXPECT_EQ(scalar_value(design.certificate.values, "lambda"), 0.7);
}

TEST(Sferlazza2019Aircraft, IsDesignedForFor4To8SecondsAtTheLargestMargin) {
  const Design design = design_by(kMethod, aircraft(4.0, 8.0));
  const NamedMatrices& values = design.certificate.values;
  EXPECT_NEAR(margin_of(values, 4.0, 8.0), 2.8e-3, 0.1e-3);
  EXPECT_LE(max_eigenvalue(values.at("P")), 1.0 + 1e-6);
  EXPECT_TRUE(verified(values, 4.0, 8.0).holds);
}

TEST(Sferlazza2019Aircraft, CannotBeObservedFromSamplesHalfATurnApart) {
  // pi / 0.36782 = 8.541
  const std::string message = refusal(kMethod, aircraft(8.5, 8.6));
  EXPECT_NE(message.find("samples 8.541"), std::string::npos) << message;
}

TEST(Sferlazza2019Aircraft, HasALargestT2BelowHalfATurn) {
  const Design design = design_by(kMethod, aircraft(7.0, 7.5), {}, Objective::kMaxT2);
  EXPECT_GT(design.certificate.subject.T2, 7.9);
  EXPECT_LT(design.certificate.subject.T2, 8.541);
}

TEST(Sferlazza2019Algorithm1, TakesAnyPWhereAllOfTheStateIsMeasured) {
  const CertificateSubject subject =
      linear_subject(aircraft(1.0, 3.0).plant.A(), Eigen::MatrixXd::Identity(3, 3), 1.0, 20.0);
  EXPECT_TRUE(all_hold(check(design_by(kMethod, subject).certificate)));
}

TEST(Sferlazza2019Algorithm1, TellsWhatItCannotDesignFor) {
  Eigen::MatrixXd C(2, 3);
  C << 1, 0, 1, 2, 0, 2;
  std::string message = refusal(kMethod, linear_subject(aircraft(1, 3).plant.A(), C, 1.0, 3.0));
  EXPECT_NE(message.find("not linearly independent"), std::string::npos) << message;

  Eigen::MatrixXd blind = Eigen::MatrixXd::Zero(1, 2);
  blind(0, 1) = 1.0;
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, 0, 0;
  message = refusal(kMethod, linear_subject(A, blind, 0.1, 1.0));
  EXPECT_NE(message.find("not detectable"), std::string::npos) << message;

  message = refusal(kMethod, aircraft(1.0, 3.0), {{"lambda", 1.0}});
  EXPECT_NE(message.find("lambda must be in [0, 1)"), std::string::npos) << message;
  message = refusal(kMethod, aircraft(1.0, 3.0), {}, Objective::kMaxDecay);
  EXPECT_NE(message.find("can't serve the objective max-decay"), std::string::npos) << message;
}

/// Follows the observer's own gain and the bound over random samples.
void expect_bound_covers_error(double lambda, double noise) {
  const CertificateSubject subject = aircraft(1.0, 3.0);
  NamedMatrices values = kPrinted_1_3;
  values["lambda"] = scalar_matrix(lambda);
  ErrorAssumptions assumptions;
  assumptions.initial_error = std::sqrt(3.0);
  assumptions.noise = noise;
  const auto bound = theorem().error_bound(subject, values, assumptions);
  std::vector<double> state(static_cast<std::size_t>(bound->state_size()));
  bound->initialize(state.data());

  const CertificateGain gain(subject.plant.C(), values.at("P"), lambda);
  Eigen::VectorXd workspace(gain.workspace_size());
  Eigen::MatrixXd K(3, 1);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Eigen::VectorXd error = Eigen::Vector3d(1, -1, 1);
  for (int j = 0; j < 100; ++j) {
    // The first sample may come at once.
    const double tau = j == 0 ? 0.4 : 1.0 + 2.0 * uniform(random);
    error = exponential_of(subject.plant.A() * tau) * error;
    bound->flow(tau, state.data());
    ASSERT_GE(bound->bound(state.data()), error.norm()) << "before sample " << j;
    gain.evaluate(exponential_of(-subject.plant.A() * tau).eval().data(), K.data(),
                  workspace.data());
    const double eta = noise * (2.0 * uniform(random) - 1.0);
    error -= K * (subject.plant.C() * error + scalar_matrix(eta));
    bound->sample(state.data());
    ASSERT_GE(bound->bound(state.data()), error.norm()) << "after sample " << j;
  }
  const double left = bound->bound(state.data());
  if (noise == 0.0) {
    EXPECT_LT(left, 1e-4);
  } else {
    EXPECT_LT(left, 1000.0 * noise);
  }
  bound->flow(3.1, state.data());
  EXPECT_TRUE(std::isinf(bound->bound(state.data())));
}

TEST(Sferlazza2019Bound, CoversTheErrorAndFalls) {
  expect_bound_covers_error(0.0, 0.0);
  expect_bound_covers_error(0.3, 0.0);
  expect_bound_covers_error(0.0, 0.01);
}

}  // namespace
}  // namespace sampled_data_observers::test
