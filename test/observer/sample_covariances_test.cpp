// The hybrid Kalman filter where the covariance of the noise comes with each sample.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "observer/hybrid_kalman_filter.h"
#include "observer/unscented_kalman_filter.h"
#include "sampled_data_observers/plant/expression_map.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/allocation_counter.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

enum class OutputForm { kLinear, kFormulas };

/// Two states, a sensor of two outputs: of one form or the other.
std::shared_ptr<const Plant> measured_plant(OutputForm form) {
  PlantDescription description;
  description.state_names = {"p", "v"};
  description.sensors = {{"a", SensorTiming::kSampled, {false, false}}};
  PlantMode mode;
  Eigen::Matrix2d A;
  A << 0.0, 1.0, -2.0, -0.3;
  mode.flow = std::make_shared<const AffineMap>(A);
  if (form == OutputForm::kLinear) {
    Eigen::Matrix2d C;
    C << 1.0, 0.0, 0.5, 1.0;
    mode.outputs = {std::make_shared<const AffineMap>(C)};
  } else {
    ExpressionNames names;
    names.x = {"p", "v"};
    mode.outputs = {std::make_shared<const ExpressionMap>(
        names, std::vector<NamedExpression>(),
        std::vector<NamedExpression>{{"y1", "sin(p)"}, {"y2", "p*v"}})};
  }
  description.modes = {mode};
  return std::make_shared<const Plant>(description);
}

/// @param R  empty: it comes with the samples
/// @param iterations  0: the unscented variant
std::shared_ptr<const ObserverLaw> filter_of(OutputForm form, const Eigen::MatrixXd& R,
                                             int iterations) {
  KalmanCovariances covariances;
  covariances.P0 = Eigen::Vector2d(1.0, 2.0).asDiagonal();
  covariances.R = {R};
  covariances.Q = Eigen::Vector2d(0.0, 0.3).asDiagonal();
  covariances.Q_d = Eigen::Matrix2d::Zero();
  const ObserverContext context{measured_plant(form), Eigen::Vector2d(0.5, -1.0),
                                Eigen::VectorXd::Zero(0)};
  if (iterations == 0) return std::make_shared<const UnscentedKalmanFilter>(context, covariances);
  covariances.iterations = iterations;
  return std::make_shared<const HybridKalmanFilter>(context, covariances);
}

Eigen::Matrix2d noise_of(double a, double b, double c) {
  Eigen::Matrix2d R;
  R << a, b, b, c;
  return R;
}

/// y and R, row by row.
struct Sampled {
  Stamp stamp;
  std::vector<double> numbers;

  Event view(bool has_covariance = true) const {
    Event event;
    event.stamp = stamp;
    event.values = numbers.data();
    event.size = 2;
    event.covariance = has_covariance ? 3 : 0;
    return event;
  }
};

std::vector<Sampled> some_samples() {
  std::vector<Sampled> samples;
  for (int i = 0; i < 8; ++i) {
    const double t = 0.1 * i;
    samples.push_back({test::kSecond + i * test::kSecond / 10,
                       {std::cos(t), std::sin(t), 0.1 + t, 0.02 * i, 0.3 - 0.2 * t}});
  }
  return samples;
}

Estimator::Options roomy() {
  Estimator::Options options;
  options.history = {100 * test::kSecond, 100};
  options.future_tolerance = 100 * test::kSecond;
  options.sampling = SensorSampling(0, kNoLongestTime);
  return options;
}

Eigen::VectorXd final_state(Estimator& estimator) {
  Estimate estimate = estimator.make_estimate();
  EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(3 * test::kSecond, estimate));
  return estimate.state;
}

class SampleCovariancesTest : public testing::TestWithParam<std::pair<OutputForm, int>> {};

TEST_P(SampleCovariancesTest, EqualOnesAreAsOneThatIsConfigured) {
  const auto [form, iterations] = GetParam();
  Estimator fixed(filter_of(form, noise_of(0.1, 0.03, 0.2), iterations), roomy());
  Estimator given(filter_of(form, {}, iterations), roomy());
  for (Sampled sample : some_samples()) {
    sample.numbers = {sample.numbers[0], sample.numbers[1], 0.1, 0.03, 0.2};
    const EventReport expected = fixed.submit(sample.view(false), test::kSecond);
    const EventReport found = given.submit(sample.view(), test::kSecond);
    EXPECT_TRUE(expected.used() && found.used());
    const bool is_first = sample.stamp == test::kSecond;  // there was no estimate
    EXPECT_EQ(is_first, std::isnan(expected.nis));
    EXPECT_EQ(is_first, std::isnan(found.nis));
    if (is_first) continue;
    EXPECT_NEAR(expected.nis, found.nis, 1e-12);
    EXPECT_NEAR(expected.innovation, found.innovation, 1e-14);
  }
  const Eigen::Index known = 2;
  EXPECT_LT((final_state(fixed).head(known) - final_state(given).head(known)).norm(), 1e-13);
}

TEST_P(SampleCovariancesTest, EachSampleHasItsOwn) {
  const auto [form, iterations] = GetParam();
  const auto after = [&, form = form, iterations = iterations](double variance) {
    Estimator estimator(filter_of(form, {}, iterations), roomy());
    estimator.submit(Sampled{test::kSecond, {0.3, -0.5, variance, 0.0, variance}}.view(),
                     test::kSecond);
    Estimate estimate = estimator.make_estimate();
    estimator.estimate_at(test::kSecond, estimate);
    const double* state = estimate.state.data();
    return std::pair(state[0], estimator.law().observer().covariance(state)[0]);
  };
  EXPECT_LT(after(1e-4).second, 0.2);
  EXPECT_GT(after(100.0).second, 0.9);
  EXPECT_NEAR(0.5, after(100.0).first, 0.1);
}

TEST_P(SampleCovariancesTest, AnyOrderOfArrivalGivesTheSameBits) {
  const auto [form, iterations] = GetParam();
  std::vector<Sampled> samples = some_samples();
  // Two that differ in their covariance alone.
  samples.push_back(samples[3]);
  samples.back().numbers[2] += 0.5;
  Estimator in_order(filter_of(form, {}, iterations), roomy());
  for (const Sampled& sample : samples) in_order.submit(sample.view(), test::kSecond);
  Estimator reversed(filter_of(form, {}, iterations), roomy());
  reversed.submit(samples[0].view(), test::kSecond);  // where the estimate begins
  for (std::size_t i = samples.size(); i-- > 1;) {
    EXPECT_TRUE(reversed.submit(samples[i].view(), test::kSecond).used());
  }
  EXPECT_EQ(final_state(in_order), final_state(reversed));
  EXPECT_EQ(EventOutcome::kDuplicate,
            reversed.submit(samples.back().view(), test::kSecond).outcome);
}

TEST_P(SampleCovariancesTest, ASampleAllocatesNothing) {
  const auto [form, iterations] = GetParam();
  Estimator estimator(filter_of(form, {}, iterations), roomy());
  const std::vector<Sampled> samples = some_samples();
  estimator.submit(samples[0].view(), test::kSecond);
  const std::size_t before = test::allocations();
  for (const Sampled& sample : samples) estimator.submit(sample.view(), test::kSecond);
  EXPECT_TRUE(test::allocations() == before || !test::allocations_are_counted());
}

TEST_P(SampleCovariancesTest, OnesThatAreMissingOrNotWantedAreRefused) {
  const auto [form, iterations] = GetParam();
  Estimator given(filter_of(form, {}, iterations), roomy());
  Estimator fixed(filter_of(form, noise_of(0.1, 0.0, 0.1), iterations), roomy());
  const Sampled sample = some_samples()[0];
  EXPECT_EQ(EventOutcome::kWrongSize, given.submit(sample.view(false), test::kSecond).outcome);
  EXPECT_EQ(EventOutcome::kWrongSize, fixed.submit(sample.view(), test::kSecond).outcome);
}

INSTANTIATE_TEST_SUITE_P(Outputs, SampleCovariancesTest,
                         ::testing::Values(std::pair(OutputForm::kLinear, 1),
                                           std::pair(OutputForm::kLinear, 0),
                                           std::pair(OutputForm::kFormulas, 0),
                                           std::pair(OutputForm::kFormulas, 1),
                                           std::pair(OutputForm::kFormulas, 3)));

}  // namespace
}  // namespace sampled_data_observers
