#include "sampled_data_observers/runtime/estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "observer/delayed_jumps.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "support/allocation_counter.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

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

  static Eigen::Vector2d input_in(const Estimate& estimate) {
    return Eigen::Vector2d(estimate.law->observer().held_part(estimate.state.data()));
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
  Estimate estimate = estimator_.make_estimate();
  estimator_.estimate_at(now_, estimate);
  EXPECT_EQ(3u, estimate.counts.events);
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

TEST_F(EstimatorTest, EachSensorsIntervalsAreComparedWithItsOwnTimes) {
  Estimator::Options own = options();
  own.sampling = SensorSampling(
      {SamplingBounds{kSecond, 2 * kSecond}, SamplingBounds{kSecond / 10, kSecond / 2}});
  Estimator estimator(test::example_law(), own);
  const auto check = [&](Stamp after, int sensor, std::vector<double> y) {
    const OwnedEvent event{kStart + after, EventKind::kSample, sensor, std::move(y)};
    return estimator.submit(event.view(), now_).interval_check;
  };
  check(0, 0, {1.0});
  check(0, 1, {0.0, 0.0});
  EXPECT_EQ(IntervalCheck::kWithin, check(kSecond / 2, 1, {0.0, 0.0}));
  EXPECT_EQ(IntervalCheck::kWithin, check(kSecond, 0, {1.0}));
  EXPECT_EQ(IntervalCheck::kLong, check(3 * kSecond / 2, 1, {0.0, 0.0}));
  EXPECT_EQ(IntervalCheck::kShort, check(3 * kSecond / 2, 0, {1.0}));
  EXPECT_EQ(IntervalCheck::kLong, check(4 * kSecond, 0, {1.0}));
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
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), input_in(estimate));
}

TEST_F(EstimatorTest, EachChannelOfInputsIsHeldUntilItsOwnNextStamp) {
  const std::shared_ptr<const Plant> example = test::example_plant();
  const auto plant =
      std::make_shared<const Plant>(PlantDescription{example->state_names(),
                                                     example->input_names(),
                                                     example->sensors(),
                                                     example->modes(),
                                                     example->integration(),
                                                     {{"force", {0}}, {"torque", {1}}}});
  const auto law = std::make_shared<const ConstantGainObserver>(
      ObserverContext{plant, Eigen::Vector3d::Zero(), Eigen::Vector2d(0.1, 0.2)},
      test::example_gains());
  Estimator estimator(law, options());
  now_ = kStart + kSecond;
  const auto take = [&](Duration after, int channel, std::vector<double> values) {
    const OwnedEvent event{kStart + after, EventKind::kInput, channel, std::move(values)};
    return estimator.submit(event.view(), now_).outcome;
  };
  const auto held = [&](Duration after) {
    Estimate estimate = estimator.make_estimate();
    estimator.estimate_at(kStart + after, estimate);
    return Eigen::Vector2d(
        Eigen::Map<const Eigen::Vector2d>(law->observer().held_part(estimate.state.data())));
  };
  EXPECT_EQ(EventOutcome::kUsed, take(10, 0, {7.0}));
  EXPECT_EQ(Eigen::Vector2d(7.0, 0.2), held(10));
  EXPECT_EQ(EventOutcome::kUsed, take(30, 1, {-3.0}));
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), held(30));
  EXPECT_EQ(EventOutcome::kUsedLate, take(20, 0, {8.0}));
  EXPECT_EQ(EventOutcome::kUsedLate, take(10, 1, {-4.0}));
  EXPECT_EQ(EventOutcome::kDuplicate, take(20, 0, {8.0}));
  EXPECT_EQ(Eigen::Vector2d(7.0, -4.0), held(10));
  EXPECT_EQ(Eigen::Vector2d(8.0, -4.0), held(20));
  EXPECT_EQ(Eigen::Vector2d(8.0, -3.0), held(30));
  EXPECT_EQ(EventOutcome::kWrongSize, take(40, 1, {1.0, 2.0}));
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
  bad.sampling = {-1, kSecond};
  EXPECT_THROW(Estimator(test::example_law(), bad), std::invalid_argument);
  bad = options();
  bad.sampling = {kSecond + 1, kSecond};
  EXPECT_THROW(Estimator(test::example_law(), bad), std::invalid_argument);
  bad.sampling = SensorSampling({SamplingBounds{0, kSecond}, SamplingBounds{2, 1}});
  EXPECT_THROW(Estimator(test::example_law(), bad), std::invalid_argument);
  bad = options();
  bad.future_tolerance = -1;
  EXPECT_THROW(Estimator(test::example_law(), bad), std::invalid_argument);
}

TEST_F(EstimatorTest, AtTheNextSampleItStartsAsNearTheConfiguredEstimateAsTheSampleAllows) {
  submit(sample(kStart));
  submit({kStart + 1, EventKind::kInput, 0, {7.0, -3.0}});
  estimator_.restart_at_next_sample(kStart + kSecond);
  Estimate estimate = estimator_.make_estimate();
  EXPECT_TRUE(estimator_.awaits_sample());
  EXPECT_FALSE(estimator_.earliest());
  EXPECT_EQ(Timeline::Query::kNoEvent, estimator_.estimate_at(now_, estimate));
  EXPECT_EQ(EventOutcome::kTooOld, submit(sample(kStart + kSecond)).outcome);
  // An input that came before the sample, but is stamped after it, goes on counting.
  submit({kStart + 2 * kSecond, EventKind::kInput, 0, {5.0, 0.0}});
  EXPECT_TRUE(estimator_.awaits_sample());

  // y = (p + 0.5 v, yaw), with yaw an angle: 3 and -3.2 + 2 pi are 0.083 apart.
  const Stamp start = kStart + 3 * kSecond / 2;
  EXPECT_EQ(EventOutcome::kUsedLate, submit({start, EventKind::kSample, 1, {2.0, -3.2}}).outcome);
  EXPECT_FALSE(estimator_.awaits_sample());
  estimator_.estimate_at(start, estimate);
  const Eigen::Vector2d correction = 1.8 * Eigen::Vector2d(1.0, 0.5) / 1.25;
  EXPECT_NEAR(0.3 + correction(0), estimate.state(0), 1e-7);
  EXPECT_NEAR(-0.2 + correction(1), estimate.state(1), 1e-7);
  EXPECT_NEAR(2.0 * std::acos(-1.0) - 3.2, estimate.state(2), 1e-7);
  EXPECT_EQ(1u, estimate.counts.samples);
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), input_in(estimate));
  estimator_.estimate_at(kStart + 2 * kSecond, estimate);
  EXPECT_EQ(Eigen::Vector2d(5.0, 0.0), input_in(estimate));
  EXPECT_EQ(EventOutcome::kTooOld, submit(sample(start - kSecond / 4)).outcome);
  EXPECT_EQ(EventOutcome::kUsedLate, submit(sample(start)).outcome);
}

TEST_F(EstimatorTest, GoesOnAfterATimeOfUnknownEventsFromWhereTheModelFlowed) {
  submit(sample(kStart));
  Estimate expected = estimator_.make_estimate();
  estimator_.estimate_at(kStart + kSecond, expected);
  estimator_.resume(kStart + kSecond);
  Estimate estimate = estimator_.make_estimate();
  EXPECT_EQ(Timeline::Query::kOk, estimator_.estimate_at(kStart + kSecond, estimate));
  EXPECT_EQ(expected.state, estimate.state);
  EXPECT_EQ(EventOutcome::kTooOld, submit(sample(kStart + kSecond / 2)).outcome);
}

TEST_F(EstimatorTest, AnotherLawTakesOverTheEstimateAndWhatIsHeld) {
  submit(sample(kStart));
  submit({kStart + 1, EventKind::kInput, 0, {7.0, -3.0}});
  Estimate before = estimator_.make_estimate();
  estimator_.estimate_at(kStart + kSecond, before);
  // Its state is larger: it is not copied, but made anew.
  Estimator other(std::make_shared<const DelayedJumps>(test::example_law()), options());
  other.take_over(estimator_, kStart + kSecond);
  Estimate after = other.make_estimate();
  ASSERT_EQ(Timeline::Query::kOk, other.estimate_at(kStart + kSecond, after));
  EXPECT_EQ(Eigen::Vector3d(before.state.head(3)), Eigen::Vector3d(after.state.head(3)));
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), input_in(after));
}

/// One that corrects nothing, so that it can be told from example_law().
std::shared_ptr<const ObserverLaw> law_without_gains() {
  return std::make_shared<const ConstantGainObserver>(
      ObserverContext{test::example_plant(), Eigen::Vector3d::Zero(), Eigen::Vector2d::Zero()},
      std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Zero(3, 1), Eigen::MatrixXd::Zero(3, 2)});
}

TEST_F(EstimatorTest, EventsOfBeforeATakeOverAreAppliedByTheLawOfTheirTime) {
  const Stamp change = kStart + kSecond;
  Estimator expected(test::example_law(), options());
  expected.submit(sample(kStart).view(), now_);
  expected.submit(sample(kStart + kSecond / 2, 9.0).view(), now_);
  Estimate before = expected.make_estimate();
  expected.estimate_at(change, before);

  submit(sample(kStart));
  Estimator other(law_without_gains(), options());
  other.take_over(estimator_, change);
  EXPECT_EQ(EventOutcome::kUsed, other.submit(sample(change + 1, 5.0).view(), now_).outcome);
  EXPECT_EQ(kStart, *other.earliest());
  const EventReport late = other.submit(sample(kStart + kSecond / 2, 9.0).view(), now_);
  EXPECT_EQ(EventOutcome::kUsedLate, late.outcome);
  EXPECT_EQ(1u, late.rewound);
  EXPECT_EQ(kSecond / 2, *late.interval);
  EXPECT_EQ(EventOutcome::kDuplicate, other.submit(sample(kStart).view(), now_).outcome);
  for (const Stamp stamp : {change, change + 1, change - 1, kStart + kSecond / 2}) {
    const Estimate* found = nullptr;
    ASSERT_EQ(Timeline::Query::kOk, other.estimate_at(stamp, found));
    EXPECT_EQ(stamp < change ? &other.at(kStart).law() : &other.law(), found->law);
    expected.estimate_at(stamp, before);
    if (stamp > change) continue;
    EXPECT_EQ(before.state.head(3), found->state.head(3));
  }
}

TEST_F(EstimatorTest, AnyOrderOfArrivalAfterATakeOverGivesTheSameBits) {
  const Stamp change = kStart + kSecond;
  std::mt19937_64 generator(7);
  std::vector<OwnedEvent> events =
      test::random_events(generator, 40, kStart + 1, 2 * kSecond);  // of before it and after it
  const auto states = [&] {
    Estimator before(test::example_law(), options());
    before.submit(sample(kStart).view(), now_);
    Estimator after(law_without_gains(), options());
    after.take_over(before, change);
    for (const OwnedEvent& event : events) after.submit(event.view(), now_);
    std::vector<double> result;
    for (Stamp stamp = kStart + 1; stamp < kStart + 3 * kSecond; stamp += kSecond / 30) {
      const Estimate* found = nullptr;
      EXPECT_EQ(Timeline::Query::kOk, after.estimate_at(stamp, found));
      result.insert(result.end(), found->state.data(), found->state.data() + found->state.size());
    }
    return result;
  };
  const std::vector<double> expected = states();
  for (int permutation = 0; permutation < 20; ++permutation) {
    std::shuffle(events.begin(), events.end(), generator);
    EXPECT_TRUE(expected == states());
  }
}

TEST_F(EstimatorTest, TheWindowCountsFromTheNewestEventAfterATakeOverToo) {
  submit(sample(kStart));
  submit(sample(kStart + kSecond));
  Estimator other(law_without_gains(), options());
  other.take_over(estimator_, kStart + 2 * kSecond);
  const Stamp later = kStart + 10 * kSecond + kSecond / 2;
  other.submit(sample(later).view(), later);
  EXPECT_EQ(EventOutcome::kTooOld, other.submit(sample(kStart + 1).view(), later).outcome);
  EXPECT_EQ(EventOutcome::kUsedLate,
            other.submit(sample(kStart + 2 * kSecond / 3).view(), later).outcome);
  // Now the newest event that is forgotten is one of the new law.
  other.submit(sample(later + 8 * kSecond).view(), later + 20 * kSecond);
  other.submit(sample(later + 10 * kSecond + 1).view(), later + 20 * kSecond);
  EXPECT_EQ(EventOutcome::kTooOld,
            other.submit(sample(kStart + kSecond / 2).view(), later + 20 * kSecond).outcome);
}

TEST_F(EstimatorTest, ATakeOverBehindAnEventOfTheFutureBeginsThere) {
  submit(sample(kStart));
  submit(sample(now_ + kSecond / 4, 3.0));
  Estimate before = estimator_.make_estimate();
  estimator_.estimate_at(now_ + kSecond / 4, before);
  Estimator other(law_without_gains(), options());
  other.take_over(estimator_, now_);
  const Estimate* found = nullptr;
  ASSERT_EQ(Timeline::Query::kOk, other.estimate_at(now_ + kSecond / 4, found));
  EXPECT_EQ(before.state.head(3), found->state.head(3));
  // And so does another one.
  Estimator third(test::example_law(), options());
  third.take_over(other, now_);
  EXPECT_EQ(EventOutcome::kUsedLate, third.submit(sample(now_).view(), now_).outcome);
}

TEST_F(EstimatorTest, WhereTheClockIsSetBackALittleAResetIsNotLost) {
  submit(sample(kStart));
  submit({kStart + 1, EventKind::kInput, 0, {7.0, -3.0}});
  const Stamp reset = kStart + kSecond;
  const Stamp now = reset - kSecond / 200;
  const Eigen::Vector3d given(1.0, 2.0, 3.0);
  estimator_.restart(reset, given);
  estimator_.restart(now, given);
  const Estimate* found = nullptr;
  ASSERT_EQ(Timeline::Query::kOk, estimator_.estimate_at(now, found));
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), input_in(*found));

  estimator_.restart(reset, given);
  Estimator other(law_without_gains(), options());
  other.take_over(estimator_, now);
  ASSERT_EQ(Timeline::Query::kOk, other.estimate_at(reset, found));
  EXPECT_EQ(given, Eigen::Vector3d(found->state.head(3)));
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), input_in(*found));
}

TEST_F(EstimatorTest, ManyTakeOversKeepTheLastOnesOnly) {
  submit(sample(kStart));
  std::unique_ptr<Estimator> last = std::make_unique<Estimator>(std::move(estimator_));
  Stamp stamp = kStart;
  for (int i = 0; i < 2 * Estimator::kEarlierLaws; ++i) {
    auto next = std::make_unique<Estimator>(test::example_law(), options());
    next->take_over(*last, stamp += kSecond / 10);
    last = std::move(next);
  }
  const Stamp oldest = stamp - Estimator::kEarlierLaws * (kSecond / 10);
  EXPECT_EQ(oldest, *last->earliest());
  EXPECT_EQ(EventOutcome::kTooOld, last->submit(sample(oldest).view(), now_).outcome);
  EXPECT_EQ(EventOutcome::kUsed, last->submit(sample(oldest + 1).view(), now_).outcome);
}

TEST_F(EstimatorTest, WhatIsHeldComesLateThroughATakeOver) {
  const OwnedEvent input{kStart + kSecond / 2, EventKind::kInput, 0, {7.0, -3.0}};
  submit(sample(kStart));
  Estimator other(test::example_law(), options());
  other.take_over(estimator_, kStart + kSecond);
  EXPECT_EQ(EventOutcome::kUsed, other.submit(input.view(), now_).outcome);
  const Estimate* found = nullptr;
  ASSERT_EQ(Timeline::Query::kOk, other.estimate_at(kStart + kSecond, found));
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), input_in(*found));
  // A reset keeps what the law of before held.
  other.restart(kStart + 3 * kSecond / 4);
  ASSERT_EQ(Timeline::Query::kOk, other.estimate_at(kStart + kSecond, found));
  EXPECT_EQ(Eigen::Vector2d(7.0, -3.0), input_in(*found));
  EXPECT_EQ(EventOutcome::kTooOld, other.submit(sample(kStart + kSecond / 2).view(), now_).outcome);
}

TEST_F(EstimatorTest, ClearedItIsAsNew) {
  submit(sample(kStart));
  submit({kStart + 1, EventKind::kInput, 0, {7.0, -3.0}});
  estimator_.restart_at_next_sample(kStart + kSecond);
  estimator_.clear();
  EXPECT_FALSE(estimator_.earliest());
  EXPECT_FALSE(estimator_.awaits_sample());
  EXPECT_EQ(EventOutcome::kUsed, submit(sample(kStart - 100 * kSecond)).outcome);
  Estimator fresh(test::example_law(), options());
  fresh.submit(sample(kStart - 100 * kSecond).view(), now_);
  Estimate estimate = estimator_.make_estimate();
  Estimate expected = fresh.make_estimate();
  estimator_.estimate_at(kStart - 99 * kSecond, estimate);
  fresh.estimate_at(kStart - 99 * kSecond, expected);
  EXPECT_EQ(expected.state, estimate.state);
}

TEST_F(EstimatorTest, ARestartAtTheNextSampleAllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const OwnedEvent first = sample(kStart);
  const OwnedEvent next = sample(kStart + 2 * kSecond, 4.0);
  submit(first);
  const std::size_t before = test::allocations();
  estimator_.restart_at_next_sample(kStart + kSecond);
  submit(next);
  EXPECT_EQ(before, test::allocations());
  EXPECT_FALSE(estimator_.awaits_sample());
}

}  // namespace
}  // namespace sampled_data_observers
