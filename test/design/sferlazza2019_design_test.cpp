// sferlazza2019: the aircraft (66), the design by Algorithm 1, and the bound that (21) gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "design/final_error.h"
#include "design/sferlazza2019_verification.h"
#include "linear_algebra/matrix_functions.h"
#include "observer/time_varying_gain.h"
#include "paper_plants.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers::test {
namespace {

const char* const kAlgorithm1 = "sferlazza2019_algorithm1";
const Theorem& rate_theorem() { return *find_theorem("sferlazza2019_theorem2"); }

NamedMatrices with_P(const std::vector<double>& upper, double lambda = 0.0) {
  Eigen::MatrixXd P(3, 3);
  P << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4], upper[5];
  return {{"P", P}, {"lambda", scalar_matrix(lambda)}};
}
/// (67) and (68)
const NamedMatrices kPrinted_1_3 = with_P({0.8334, -0.0041, 0.8333, 2.0116, -0.0359, 0.8341});
const NamedMatrices kPrinted_4_8 = with_P({0.9573, -0.0031, 0.9571, 2.2754, -0.0122, 0.9573});

double margin_of(const NamedMatrices& values, double T1, double T2) {
  const Condition condition = rate_theorem().conditions(aircraft(T1, T2)).back();
  return least_eigenvalue(condition.positive_definite, values, *condition.tau, 2001);
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
  const Design design = design_by(kAlgorithm1, aircraft(1.0, 3.0));
  EXPECT_EQ(design.solver, "interior point, in 1 iteration");
  EXPECT_TRUE(all_hold(check(design.certificate)));
  EXPECT_TRUE(verified(design.certificate.values, 1.0, 3.0).holds);
}

TEST(Sferlazza2019Aircraft, IsDesignedForFor3To4SecondsAgainstThePaper) {
  const Design design = design_by(kAlgorithm1, aircraft(3.0, 4.0), {{"lambda", 0.7}});
  EXPECT_TRUE(verified(design.certificate.values, 3.0, 4.0).holds);
  EXPECT_EQ(scalar_value(design.certificate.values, "lambda"), 0.7);
}

TEST(Sferlazza2019Aircraft, IsDesignedForFor4To8Seconds) {
  const Design design = design_by(kAlgorithm1, aircraft(4.0, 8.0));
  EXPECT_TRUE(all_hold(check(design.certificate)));
  EXPECT_TRUE(verified(design.certificate.values, 4.0, 8.0).holds);
}

TEST(Sferlazza2019Aircraft, CannotBeObservedFromSamplesHalfATurnApart) {
  // pi / 0.36782 = 8.541
  const std::string message = refusal(kAlgorithm1, aircraft(8.5, 8.6));
  EXPECT_NE(message.find("samples 8.541"), std::string::npos) << message;
}

TEST(Sferlazza2019Aircraft, HasALargestT2BelowHalfATurn) {
  const Design design = design_by(kAlgorithm1, aircraft(7.0, 7.5), {}, Objective::kMaxT2);
  EXPECT_GT(design.certificate.subject.T2, 7.9);
  EXPECT_LT(design.certificate.subject.T2, 8.541);
}

Eigen::MatrixXd gain_at(const CertificateGain& gain, const Eigen::MatrixXd& backward) {
  Eigen::MatrixXd K(backward.rows(), 1);
  Eigen::VectorXd workspace(gain.workspace_size());
  gain.evaluate(backward.data(), K.data(), workspace.data());
  return K;
}

/// The rate multiplies Ψ by e^{−2 decay τ}, which cancels in (25).
TEST(Sferlazza2019Aircraft, HasTheSameGainForAPlantThatDecaysFaster) {
  const CertificateSubject subject = aircraft(1.0, 3.0);
  const CertificateGain gain(subject.plant.C(), kPrinted_1_3.at("P"), 0.0);
  for (const double tau : {1.0, 2.0, 3.0}) {
    const Eigen::MatrixXd backward = exponential_of(-tau * subject.plant.A());
    const Eigen::MatrixXd K = gain_at(gain, backward);
    EXPECT_LT(norm2(gain_at(gain, std::exp(-0.7 * tau) * backward) - K), 1e-9 * norm2(K));
  }
}

/// With λ > 0 as without: V falls by e^{−2 decay τ} from sample to sample, with the observer's
/// gain.
TEST(Sferlazza2019Aircraft, ConvergesAtTheRateThatIsProved) {
  for (const double lambda : {0.0, 0.1}) {
    const CertificateSubject subject = aircraft(1.0, 3.0);
    const Design design =
        design_by(kAlgorithm1, subject, {{"lambda", lambda}}, Objective::kMaxDecay);
    const NamedMatrices& values = design.certificate.values;
    const double decay = scalar_value(values, "decay");
    // By (21) alone, with lambda = 0, 0.149 1/s.
    EXPECT_GE(decay, lambda == 0.0 ? 1.0 : 0.5) << lambda;
    const Eigen::MatrixXd R = cholesky_root(values.at("P"));
    const Eigen::MatrixXd& C = subject.plant.C();
    const CertificateGain gain(C, values.at("P"), lambda);
    for (int i = 0; i <= 40; ++i) {
      const double tau = 1.0 + 2.0 * i / 40.0;
      const Eigen::MatrixXd flow = exponential_of(tau * subject.plant.A());
      const Eigen::MatrixXd K = gain_at(gain, exponential_of(-tau * subject.plant.A()));
      EXPECT_LE(norm2(R * (flow - K * (C * flow)) * inverse_of(R)), std::exp(-decay * tau)) << tau;
    }
  }
}

TEST(Sferlazza2019Theorem2, GivesNoBoundForANegativeRate) {
  NamedMatrices values = kPrinted_1_3;
  values["decay"] = scalar_matrix(-1.0);
  EXPECT_THROW(find_theorem("sferlazza2019_theorem2_rate")
                   ->error_bound(aircraft(1.0, 3.0), values, ErrorAssumptions()),
               std::invalid_argument);
}

TEST(Sferlazza2019Equation17, KeepsLambdaOfTheErrorAtEachSample) {
  const CertificateSubject subject =
      linear_subject(aircraft(1.0, 3.0).plant.A(), Eigen::MatrixXd::Identity(3, 3), 1.0, 3.0);
  const Design design = design_by("sferlazza2019_equation17", subject, {{"lambda", 0.3}});
  ErrorAssumptions assumptions;
  assumptions.initial_error = 2.0;
  const auto bound =
      design.certificate.theorem->error_bound(subject, design.certificate.values, assumptions);
  std::vector<double> state(static_cast<std::size_t>(bound->state_size()));
  std::vector<double> workspace(static_cast<std::size_t>(bound->workspace_size()));
  bound->initialize(state.data());
  for (const double tau : {1.0, 3.0, 2.0}) {
    bound->flow(tau, state.data());
    bound->sample(0, state.data(), workspace.data());
  }
  const double error = 2.0 * 0.3 * 0.3 * 0.3;
  EXPECT_GE(bound->bound(state.data()), error);
  EXPECT_LE(bound->bound(state.data()), 1.02 * error);
  EXPECT_NE(refusal("sferlazza2019_equation17", aircraft(1.0, 3.0)).find("square and invertible"),
            std::string::npos);
}

TEST(Sferlazza2019Algorithm1, TakesAnyPWhereAllOfTheStateIsMeasured) {
  const CertificateSubject subject =
      linear_subject(aircraft(1.0, 3.0).plant.A(), Eigen::MatrixXd::Identity(3, 3), 1.0, 20.0);
  EXPECT_TRUE(all_hold(check(design_by(kAlgorithm1, subject).certificate)));
}

TEST(Sferlazza2019Algorithm1, TellsWhatItCannotDesignFor) {
  Eigen::MatrixXd C(2, 3);
  C << 1, 0, 1, 2, 0, 2;
  std::string message = refusal(kAlgorithm1, linear_subject(aircraft(1, 3).plant.A(), C, 1.0, 3.0));
  EXPECT_NE(message.find("not linearly independent"), std::string::npos) << message;

  Eigen::MatrixXd blind = Eigen::MatrixXd::Zero(1, 2);
  blind(0, 1) = 1.0;
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, 0, 0;
  message = refusal(kAlgorithm1, linear_subject(A, blind, 0.1, 1.0));
  EXPECT_NE(message.find("not detectable"), std::string::npos) << message;

  message = refusal(kAlgorithm1, aircraft(1.0, 3.0), {{"lambda", 1.0}});
  EXPECT_NE(message.find("lambda must be in [0, 1)"), std::string::npos) << message;
  message = refusal(kAlgorithm1, aircraft(1.0, 3.0), {{"decay", -0.1}});
  EXPECT_NE(message.find("decay must not be negative"), std::string::npos) << message;
  message = refusal(kAlgorithm1, aircraft(1.0, 3.0), {{"lambda", 0.5}, {"decay", 0.3}});
  EXPECT_NE(message.find("falls more slowly than by decay"), std::string::npos) << message;
}

/// Theorem 2's bound beside an error that the observer's own gain corrects.
class BoundedError {
 public:
  BoundedError(const CertificateSubject& subject, const NamedMatrices& values,
               const ErrorAssumptions& assumptions, const Eigen::VectorXd& error)
      : A_(subject.plant.A()),
        C_(subject.plant.C()),
        bound_(rate_theorem().error_bound(subject, values, assumptions)),
        gain_(C_, values.at("P"), scalar_value(values, "lambda")),
        state_(static_cast<std::size_t>(bound_->state_size())),
        workspace_(static_cast<std::size_t>(bound_->workspace_size())),
        gain_workspace_(gain_.workspace_size()),
        K_(A_.rows(), C_.rows()),
        error_(error) {
    bound_->initialize(state_.data());
  }

  /// The larger of error/bound before and after a sample at tau [s].
  double share_after(double tau, double eta = 0.0) {
    error_ = exponential_of(A_ * tau) * error_;
    bound_->flow(tau, state_.data());
    const double before = error_.norm() / value();
    gain_.evaluate(exponential_of(-A_ * tau).eval().data(), K_.data(), gain_workspace_.data());
    error_ -= K_ * (C_ * error_ + scalar_matrix(eta));
    bound_->sample(0, state_.data(), workspace_.data());
    return std::max(before, error_.norm() / value());
  }
  double value() const { return bound_->bound(state_.data()); }
  const Eigen::VectorXd& error() const { return error_; }

 private:
  Eigen::MatrixXd A_;
  Eigen::MatrixXd C_;
  std::unique_ptr<const ErrorBound> bound_;
  CertificateGain gain_;
  std::vector<double> state_;
  std::vector<double> workspace_;
  Eigen::VectorXd gain_workspace_;
  Eigen::MatrixXd K_;
  Eigen::VectorXd error_;
};

ErrorAssumptions assuming(double initial_error, double noise) {
  ErrorAssumptions assumptions;
  assumptions.initial_error = initial_error;
  assumptions.noise = noise;
  return assumptions;
}

/// Follows the observer's own gain and the bound over random samples.
void expect_bound_covers_error(double lambda, double noise) {
  const CertificateSubject subject = aircraft(1.0, 3.0);
  NamedMatrices values = kPrinted_1_3;
  values["lambda"] = scalar_matrix(lambda);
  BoundedError run(subject, values, assuming(std::sqrt(3.0), noise), Eigen::Vector3d(1, -1, 1));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto follow = [&](double tau) {
    ASSERT_LE(run.share_after(tau, noise * (2.0 * uniform(random) - 1.0)), 1.0) << tau;
  };
  // The first sample may come at once.
  follow(0.4);
  for (int j = 0; j < 100; ++j) follow(1.0 + 2.0 * uniform(random));
  const double steady = run.value();
  EXPECT_LT(steady, noise == 0.0 ? 1e-4 : 1000.0 * noise);
  // Other times are covered, too, and it falls again after them.
  for (const double tau : {3.1, 7.0, 0.2, 0.0, 0.9, 12.0}) follow(tau);
  EXPECT_TRUE(std::isfinite(run.value()));
  for (int j = 0; j < 100; ++j) follow(1.0 + 2.0 * uniform(random));
  EXPECT_LT(run.value(), noise == 0.0 ? 1e-4 : 1000.0 * noise);
}

TEST(Sferlazza2019Verification, StepsForwardByTheLargestEigenvalue) {
  // Example 1 with α = 0.15: (23) holds at T1 and not at T2, where the ratio of both sides is
  // 0.930.
  Eigen::MatrixXd A(2, 2);
  A << 0.15, 1, -1, 0.15;
  const Eigen::MatrixXd P = Eigen::Vector2d(1.0, 1.0 / 2.347).asDiagonal();
  const auto ratio = [&](double tau) {
    const double s = std::sin(tau);
    const double c = std::cos(tau);
    return std::exp(-2.0 * 0.15 * tau) * (P(0, 0) * s * s + P(1, 1) * c * c) / P(1, 1);
  };
  EXPECT_GT(ratio(1.8629), 1.0);
  EXPECT_NEAR(ratio(2.2440), 0.930, 0.001);
  const Eigen::MatrixXd complement = Eigen::Vector2d(0.0, 1.0);
  const IntervalVerification whole = verify_between(A, complement, P, 1.8629, 2.2440);
  EXPECT_FALSE(whole.holds);
  ASSERT_TRUE(whole.stopped_at);
  EXPECT_NEAR(ratio(*whole.stopped_at), 1.0, 1e-3);
  const IntervalVerification part = verify_between(A, complement, P, 1.8629, 2.1);
  EXPECT_GT(ratio(2.1), 1.0);
  EXPECT_TRUE(part.holds);
}

/// A light oscillation, far faster than the times between samples: the norms change within 1 % of
/// T2 as much as over all of it.
CertificateSubject fast_oscillation() {
  Eigen::MatrixXd A(2, 2);
  A << -0.12, 60, -60, -0.12;
  Eigen::MatrixXd C(1, 2);
  C << 1, 0;
  return linear_subject(A, C, 0.5, 5.0);
}

TEST(Sferlazza2019Bound, CoversTheErrorOfAFastOscillation) {
  const CertificateSubject subject = fast_oscillation();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.5, 5.0);
  for (const double lambda : {0.0, 0.5}) {
    const NamedMatrices values = {{"P", Eigen::Vector2d(1.0, 0.01).asDiagonal()},
                                  {"lambda", scalar_matrix(lambda)}};
    for (int run = 0; run < 50; ++run) {
      const double angle = 6.283 * run / 50.0;
      BoundedError bounded(subject, values, assuming(1.0, 0.0),
                           Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      double largest = 0.0;
      for (int j = 0; j < 20 && bounded.error().norm() > 1e-11; ++j) {
        // Of some times, the one after which the error is largest.
        double tau = 0.0;
        double worst = -1.0;
        for (int k = 0; k < 100; ++k) {
          const double candidate = uniform(random);
          const double after = (exponential_of(subject.plant.A() * candidate) * bounded.error())(1);
          if (std::abs(after) > worst) {
            worst = std::abs(after);
            tau = candidate;
          }
        }
        largest = std::max(largest, bounded.share_after(tau));
      }
      ASSERT_LE(largest, 1.0) << "lambda " << lambda << ", run " << run;
      EXPECT_GT(largest, 0.05);
    }
  }
}

TEST(Sferlazza2019Bound, AllocatesNothingAtSamples) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const auto bound =
      rate_theorem().error_bound(aircraft(1.0, 3.0), kPrinted_1_3, assuming(1.0, 0.1));
  std::vector<double> state(static_cast<std::size_t>(bound->state_size()));
  std::vector<double> workspace(static_cast<std::size_t>(bound->workspace_size()));
  const std::size_t before = allocations();
  bound->initialize(state.data());
  bound->flow(2.0, state.data());
  bound->sample(0, state.data(), workspace.data());
  EXPECT_EQ(before, allocations());
}

TEST(Sferlazza2019Bound, CoversTheErrorAndFalls) {
  expect_bound_covers_error(0.0, 0.0);
  expect_bound_covers_error(0.3, 0.0);
  expect_bound_covers_error(0.0, 0.01);
}

TEST(Sferlazza2019, SaysNothingOfDisturbances) {
  for (const DesignMethod* method : design_methods()) {
    if (method->name().rfind("sferlazza2019", 0) != 0) continue;
    EXPECT_FALSE(bounds_disturbances(method->theorem())) << method->name();
  }
  EXPECT_TRUE(bounds_disturbances(*find_theorem("ferrante2019_theorem2")));
}

}  // namespace
}  // namespace sampled_data_observers::test
