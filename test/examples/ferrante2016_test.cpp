// The two numerical examples of ferrante2016, section 5, as shipped.
#include <gtest/gtest.h>

#include <cmath>

#include "sampled_data_observers/runtime/estimator.h"
#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

/// Example 1: A = M = 1, T1 = T2 = 1, L = 1.1 - 1/e, P = 1.
const double kL = 1.1 - std::exp(-1.0);

double beta() { return std::abs(std::pow(1.0 - kL, 2) * std::exp(2.0) - 1.0); }
double theta() { return std::log(1.0 - beta() / std::exp(2.0)); }
/// gamma = R = |theta| T2 / (1 + T2), both from (20a) with T2 = 1.
double gamma_of_bound() { return -theta() / 2.0; }
/// (21) with alpha_1 = 1, alpha_2 = e^2.
double bound(double t, int j, double initial_error) {
  return std::exp(gamma_of_bound() / 2.0) * std::exp(1.0) *
         std::exp(-gamma_of_bound() * (t + j) / 2.0) * initial_error;
}

TEST(Ferrante2016Example1, TheConstantsAreThePapers) {
  EXPECT_NEAR(0.7321, kL, 5e-5);
  EXPECT_NEAR(0.4698, beta(), 5e-5);
  EXPECT_NEAR(-0.0657, theta(), 5e-5);
  EXPECT_NEAR(0.0328, gamma_of_bound(), 5e-5);
}

TEST(Ferrante2016Example1, TheErrorObeysTheExponentialBoundAtEveryInstant) {
  const ObserverConfig config =
      Example("ferrante2016_scalar", kPrinted).observer("scenario.yaml", "observer.yaml");
  constexpr Stamp kStart = kNanosecondsPerSecond;
  for (const double first_sample : {0.001, 0.3, 1.0}) {
    Estimator estimator(config.law, config.options);
    estimator.restart(kStart);  // t = 0, before any sample
    const double z0 = 0.8;
    const auto truth = [&](double t) { return z0 * std::exp(t); };
    int j = 0;
    Estimate estimate = estimator.make_estimate();
    const auto check = [&](double t) {
      ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + from_seconds(t), estimate));
      EXPECT_LE(std::abs(truth(t) - estimate.state(0)), bound(t, j, z0)) << "t=" << t << " j=" << j;
    };
    double t = 0.0;
    for (int k = 0; k < 12; ++k) {
      const double sample_time = first_sample + k;
      for (; t < sample_time; t += 0.01) check(t);
      check(sample_time);
      const double y = truth(sample_time);
      const Stamp stamp = kStart + from_seconds(sample_time);
      ASSERT_TRUE(estimator.submit({stamp, EventKind::kSample, 0, &y, 1}, stamp).used());
      ++j;
      check(sample_time);
    }
  }
}

TEST(Ferrante2016Example1, TheShippedScenarioMultipliesTheErrorAsDesigned) {
  const ExampleRun run = Example("ferrante2016_scalar", kPrinted).from_zero().run();
  ASSERT_EQ(10u, run.sample_times.size());
  ASSERT_EQ(1001u, run.error.size());
  std::size_t j = 0;
  for (std::size_t k = 0; k < run.error.size(); ++k) {
    const double t = run.error.time(k);
    while (j < 10 && run.sample_times[j] <= t) ++j;
    // Exactly: e^t in all, and 1 - L at each sample.
    const double error = 0.8 * std::exp(t) * std::pow(1.0 - kL, static_cast<double>(j));
    ASSERT_NEAR(-error, run.error.value(k)(0), 1e-10 * (1.0 + run.truth.value(k)(0))) << t;
    ASSERT_LE(error, bound(t, static_cast<int>(j), 0.8)) << t;
  }
  EXPECT_LT(run.error.max(), 1.2);
  EXPECT_LT(run.error.at(10.0), 0.1);
}

/// Example 2: mass and spring with a biased sensor, the printed gain; b = 1.
class Ferrante2016Example2 : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Ferrante2016Example2, TheErrorFallsBelowAMillionthOfItsStart) {
  const ExampleRun run =
      Example("ferrante2016_mass_spring", kPrinted).seed(GetParam()).duration(200.0).run();
  EXPECT_EQ(0u, run.refused);
  EXPECT_GT(run.duplicates, 0u);
  EXPECT_NEAR(std::sqrt(5.0), run.error.at(0.0), 1e-12);
  EXPECT_LT(run.error.at(200.0), 1e-6 * std::sqrt(5.0));
  EXPECT_LT(run.error.component(4).at(200.0), 1e-6);
  for (std::size_t j = 1; j < run.sample_times.size(); ++j) {
    const double interval = run.sample_times[j] - run.sample_times[j - 1];
    ASSERT_TRUE(0.2 - 1e-9 <= interval && interval <= 3.0 + 1e-9) << interval;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Ferrante2016Example2, ::testing::Range<std::uint64_t>(0, 10));

TEST(Ferrante2016Example2Shipped, TheEstimateConvergesWithinAMinute) {
  const ExampleRun run = Example("ferrante2016_mass_spring", kPrinted).run();
  EXPECT_LT(run.error.from(20.0).max(), 0.1);
  EXPECT_LT(run.error.from(40.0).max(), 1e-2);
  EXPECT_LT(run.error.from(58.0).max(), 1e-3);
}

}  // namespace
}  // namespace sampled_data_observers::test
