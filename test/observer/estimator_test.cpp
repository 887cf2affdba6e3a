#include "sampled_data_observers/observer/estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/allocation_counter.h"
#include "support/random_events.h"

namespace sampled_data_observers {
namespace {

using test::OwnedEvent;

constexpr Stamp kStart = 1'600'000'000'000'000'000;
constexpr Duration kSecond = kNanosecondsPerSecond;

class EstimatorTest : public ::testing::Test {
 protected:
  static Estimator::Options options() {
    Estimator::Options result;
    result.history = {10 * kSecond, 1000};
    result.sampling = {kSecond / 10, kSecond};
    result.future_tolerance = kSecond / 2;
    return result;
  }
  EventReport submit(const OwnedEvent& event) { return estimator_.submit(event.view(), now_); }
  static OwnedEvent sample(Stamp stamp, double value = 1.0) {
    return {stamp, EventKind::kSample, 0, {value}};
  }

  Stamp now_ = kStart + 5 * kSecond;
  Estimator estimator_{test::example_law(), options()};
};

TEST_F(EstimatorTest, SaysWhatBecameOfEachEvent) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(EventOutcome::kUsed, submit(sample(kStart)).outcome);
  EXPECT_EQ(EventOutcome::kUsed, submit(sample(kStart + kSecond)).outcome);
  EXPECT_EQ(EventOutcome::kUsedLate, submit(sample(kStart + kSecond / 2)).outcome);
  EXPECT_EQ(EventOutcome::kDuplicate, submit(sample(kStart)).outcome);
  EXPECT_EQ(EventOutcome::kTooOld, submit(sample(kStart - 20 * kSecond)).outcome);
  EXPECT_EQ(EventOutcome::kInFuture, submit(sample(now_ + kSecond)).outcome);
  EXPECT_EQ(EventOutcome::kNoStamp, submit(sample(0)).outcome);
  EXPECT_EQ(EventOutcome::kNotFinite, submit(sample(kStart + 1, kNaN)).outcome);
  EXPECT_EQ(EventOutcome::kNotFinite, submit(sample(kStart + 1, -kInfinity)).outcome);
  EXPECT_EQ(EventOutcome::kWrongSize, submit({kStart + 1, EventKind::kSample, 0, {}}).outcome);
  EXPECT_EQ(EventOutcome::kWrongSize,
            submit({kStart + 1, EventKind::kSample, 0, {1.0, 2.0}}).outcome);
  EXPECT_EQ(3u, estimator_.timeline().size());
}

TEST_F(EstimatorTest, AnEventInTheNearFutureIsTakenInButHasNoEffectYet) {
  submit(sample(kStart));
  EXPECT_EQ(EventOutcome::kUsed, submit(sample(now_ + kSecond / 4)).outcome);
  Estimate estimate = estimator_.make_estimate();
  estimator_.estimate_at(now_, estimate);
  EXPECT_EQ(1u, estimate.counts.events);
}

TEST_F(EstimatorTest, ChecksTheIntervalsBetweenSamples) {
  EXPECT_EQ(IntervalCheck::kNone, submit(sample(kStart)).interval_check);
  const EventReport within = submit(sample(kStart + kSecond / 2));
  EXPECT_EQ(IntervalCheck::kWithin, within.interval_check);
  EXPECT_EQ(kSecond / 2, *within.interval);
  EXPECT_EQ(IntervalCheck::kLong, submit(sample(kStart + 2 * kSecond)).interval_check);
  EXPECT_EQ(IntervalCheck::kShort, submit(sample(kStart + 2 * kSecond + 1)).interval_check);
  // Each sensor has intervals of its own.
  EXPECT_FALSE(submit({kStart + kSecond / 2, EventKind::kSample, 1, {0.0, 0.0}}).interval);
  EXPECT_EQ(kSecond,
            *submit({kStart + 3 * kSecond / 2, EventKind::kSample, 1, {0.0, 0.0}}).interval);
  EXPECT_FALSE(submit({kStart + 3 * kSecond, EventKind::kJump, 0, {}}).interval);
}

TEST_F(EstimatorTest, RestartsFromTheConfiguredOrAGivenEstimate) {
  submit(sample(kStart));
  estimator_.restart(kStart + kSecond);
  Estimate estimate = estimator_.make_estimate();
  EXPECT_EQ(Timeline::Query::kOk, estimator_.estimate_at(kStart + kSecond, estimate));
  EXPECT_EQ(Eigen::Vector3d(0.3, -0.2, 3.0), Eigen::Vector3d(estimate.state.head(3)));
  EXPECT_EQ(EventOutcome::kTooOld, submit(sample(kStart + kSecond)).outcome);
  const Eigen::VectorXd given = Eigen::Vector3d(1.0, 2.0, 3.0);
  estimator_.restart(kStart + 2 * kSecond, given);
  estimator_.estimate_at(kStart + 2 * kSecond, estimate);
  EXPECT_EQ(given, estimate.state.head(3));
}

TEST_F(EstimatorTest, TheIntervalReachesBackBeyondTheWindow) {
  submit(sample(kStart));
  submit({kStart + kSecond, EventKind::kInput, 0, {1.0, 2.0}});
  now_ = kStart + 60 * kSecond;
  EXPECT_EQ(60 * kSecond, *submit(sample(now_)).interval);
}

TEST_F(EstimatorTest, NoSampleHoweverLargeMakesItDeaf) {
  LinearPlantDescription plant;  // x' = x: an unstable one, corrected by half at each sample
  plant.state_names = {"x"};
  plant.A = Eigen::MatrixXd::Ones(1, 1);
  plant.B = Eigen::MatrixXd::Zero(1, 0);
  plant.sensors = {{"s", Eigen::MatrixXd::Ones(1, 1), {false}}};
  const auto law = std::make_shared<const ConstantGainObserver>(
      ObserverContext{make_linear_plant(plant), Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(0)},
      std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Constant(1, 1, 0.5)});
  Estimator estimator(law, options());
  const auto take = [&](Stamp stamp, double value) {
    return estimator.submit(sample(stamp, value).view(), stamp).outcome;
  };
  EXPECT_EQ(EventOutcome::kUsed, take(kStart, 1.0));
  EXPECT_EQ(EventOutcome::kNotFinite, take(kStart + 1, 2e307));
  EXPECT_EQ(EventOutcome::kUsed, take(kStart + 2, 1e100));
  for (int i = 1; i < 1000; ++i) {
    EXPECT_EQ(EventOutcome::kUsed, take(kStart + i * kSecond / 10, 1.0));
  }
  Estimate estimate = estimator.make_estimate();
  estimator.estimate_at(kStart + 999 * kSecond / 10, estimate);
  EXPECT_NEAR(1.0, estimate.state(0), 0.2);
}

TEST_F(EstimatorTest, ARestartKeepsTheInput) {
  submit(sample(kStart));
  submit({kStart + 1, EventKind::kInput, 0, {7.0, -3.0}});
  estimator_.restart(kStart + kSecond);
  Estimate estimate = estimator_.make_estimate();
  estimator_.estimate_at(kStart + kSecond, estimate);
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), Eigen::Vector2d(estimate.state.segment<2>(5)));
}

TEST_F(EstimatorTest, EventsAndEstimatesAllocateNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  std::mt19937_64 generator(5);
  const std::vector<OwnedEvent> events = test::random_events(generator, 300, kStart, 5 * kSecond);
  Estimate estimate = estimator_.make_estimate();
  const std::size_t before = test::allocations();
  for (const OwnedEvent& event : events) {
    submit(event);
    estimator_.estimate_at(event.stamp, estimate);
  }
  EXPECT_EQ(before, test::allocations());
}

TEST_F(EstimatorTest, RefusesBoundsThatMakeNoSense) {
  Estimator::Options bad = options();
  bad.sampling.T1 = 0;
  EXPECT_THROW(Estimator(test::example_law(), bad), std::invalid_argument);
  bad = options();
  bad.sampling.T1 = bad.sampling.T2 + 1;
  EXPECT_THROW(Estimator(test::example_law(), bad), std::invalid_argument);
  bad = options();
  bad.future_tolerance = -1;
  EXPECT_THROW(Estimator(test::example_law(), bad), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
