// Jumps that come late, and jumps that come too fast.
#include <gtest/gtest.h>

#include <algorithm>

#include "observer/delayed_jumps.h"
#include "observer/limited_jumps.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/law_runner.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::LawRunner;

Estimator::Options options() {
  Estimator::Options result;
  result.history = {100 * kSecond, 5000};
  result.sampling = {kSecond, kSecond};
  result.future_tolerance = kSecond / 2;
  return result;
}

TEST(DelayedJumpsTest, TheResetOfTheJumpIsAppliedAtItsRelease) {
  LawRunner plain(test::example_law());
  LawRunner delayed(std::make_shared<const DelayedJumps>(test::example_law()));
  for (LawRunner* runner : {&plain, &delayed}) runner->flow(kSecond / 2);
  const Eigen::VectorXd before = delayed.estimate();
  LawRunner at_jump = plain;
  at_jump.jump();
  delayed.jump();
  EXPECT_EQ(before, delayed.estimate());
  for (LawRunner* runner : {&plain, &delayed}) runner->flow(kSecond / 10);
  EXPECT_EQ(plain.estimate(), delayed.estimate());
  EXPECT_FALSE(delayed.release(kSecond));  // of another jump
  EXPECT_EQ(plain.estimate(), delayed.estimate());
  EXPECT_TRUE(delayed.release(kSecond / 10));
  EXPECT_EQ(at_jump.estimate(), delayed.estimate());  // z+ = mu, which did not flow
}

TEST(DelayedJumpsTest, WhatIsHeldStaysAtTheRelease) {
  LawRunner delayed(std::make_shared<const DelayedJumps>(test::example_law()));
  delayed.jump();
  delayed.flow(kSecond / 10);
  delayed.input({7.0, -3.0});
  delayed.release(kSecond / 10);
  LawRunner expected(test::example_law());
  expected.jump();
  expected.input({7.0, -3.0});
  for (LawRunner* runner : {&delayed, &expected}) runner->flow(kSecond / 3);
  EXPECT_EQ(expected.estimate(), delayed.estimate());
}

TEST(DelayedJumpsTest, ANewJumpAppliesThePendingOneFirst) {
  LawRunner delayed(std::make_shared<const DelayedJumps>(test::example_law()));
  delayed.jump();
  delayed.flow(kSecond / 10);
  delayed.jump();
  LawRunner expected(test::example_law());
  expected.jump();
  EXPECT_EQ(expected.estimate(), delayed.estimate());
  EXPECT_FALSE(delayed.release(kSecond / 10));
  EXPECT_TRUE(delayed.release(0));
  expected.jump();
  EXPECT_EQ(expected.estimate(), delayed.estimate());
}

TEST(DelayedJumpsTest, TheEventSaysWhenTheResetTakesEffectOrItsArrivalDoes) {
  const auto law = std::make_shared<const DelayedJumps>(test::example_law());
  Estimator told(law, options());
  Estimator arrived(law, options());
  const double y = 1.0;
  for (Estimator* estimator : {&told, &arrived}) {
    ASSERT_TRUE(
        estimator->submit({kStart, EventKind::kSample, 0, &y, 1, 0}, kStart + kSecond).used());
  }
  const Stamp jump = kStart + kSecond / 4;
  const Stamp release = kStart + kSecond / 2;
  EXPECT_TRUE(
      told.submit({jump, EventKind::kJump, 0, nullptr, 0, release}, kStart + 2 * kSecond).used());
  EXPECT_TRUE(arrived.submit({jump, EventKind::kJump, 0, nullptr, 0, 0}, release).used());
  Estimate a = told.make_estimate();
  Estimate b = told.make_estimate();
  for (Stamp stamp = kStart; stamp < kStart + kSecond; stamp += kSecond / 50) {
    ASSERT_EQ(Timeline::Query::kOk, told.estimate_at(stamp, a));
    ASSERT_EQ(Timeline::Query::kOk, arrived.estimate_at(stamp, b));
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(stamp >= release ? 3u : (stamp >= jump ? 2u : 1u), a.counts.events);
    EXPECT_EQ(stamp >= jump ? 1u : 0u, a.counts.jumps);
  }
}

TEST(DelayedJumpsTest, AReleaseFarInTheFutureIsRefused) {
  Estimator estimator(std::make_shared<const DelayedJumps>(test::example_law()), options());
  EXPECT_EQ(
      EventOutcome::kInFuture,
      estimator.submit({kStart, EventKind::kJump, 0, nullptr, 0, kStart + 1000 * kSecond}, kStart)
          .outcome);
}

TEST(LimitedJumpsTest, AJumpTooSoonAfterAnotherHasNoEffect) {
  LawRunner limited(
      std::make_shared<const LimitedJumps>(test::example_law(), JumpLimits{kSecond / 100, 1000.0}));
  EXPECT_TRUE(limited.jump());
  limited.flow(kSecond / 100 - 1);
  const Eigen::VectorXd before = limited.estimate();
  EXPECT_FALSE(limited.jump());
  EXPECT_EQ(before, limited.estimate());
  limited.flow(1);
  EXPECT_TRUE(limited.jump());
}

TEST(LimitedJumpsTest, NoMoreJumpsThanTheRateAllows) {
  LawRunner limited(std::make_shared<const LimitedJumps>(test::example_law(), JumpLimits{0, 20.0}));
  int applied = 0;
  for (int i = 0; i < 1000; ++i) {  // 100 a second for 10 s: 20 at once, then 20 a second
    if (limited.jump()) ++applied;
    limited.flow(kSecond / 100);
  }
  EXPECT_NEAR(20 + 10 * 20, applied, 2);
}

TEST(LimitedJumpsTest, AFloodIsReportedAndTheEstimateGoesOn) {
  Estimator estimator(
      std::make_shared<const LimitedJumps>(test::example_law(), JumpLimits{kSecond / 1000, 50.0}),
      options());
  int used = 0;
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {  // a detector gone mad: 100 000 jumps a second
    const Stamp stamp = kStart + i * (kSecond / 100000);
    const EventOutcome outcome =
        estimator.submit({stamp, EventKind::kJump, 0, nullptr, 0, 0}, stamp).outcome;
    used += outcome == EventOutcome::kUsed ? 1 : 0;
    refused += outcome == EventOutcome::kTooFrequent ? 1 : 0;
  }
  EXPECT_EQ(20000, used + refused);
  EXPECT_LE(used, 50 + 10 + 1);
  Estimate estimate = estimator.make_estimate();
  ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + kSecond, estimate));
  EXPECT_EQ(static_cast<std::uint64_t>(used), estimate.counts.jumps);
}

TEST(LimitedJumpsTest, WhichJumpsHaveEffectDoesNotDependOnTheirArrival) {
  const auto law =
      std::make_shared<const LimitedJumps>(test::example_law(), JumpLimits{kSecond / 10, 1000.0});
  std::vector<Stamp> stamps = {kStart, kStart + kSecond / 20, kStart + kSecond / 9,
                               kStart + kSecond / 8, kStart + kSecond / 4};
  std::vector<double> states;
  do {
    Estimator estimator(law, options());
    for (const Stamp stamp : stamps) {
      estimator.submit({stamp, EventKind::kJump, 0, nullptr, 0, 0}, kStart + kSecond);
    }
    Estimate estimate = estimator.make_estimate();
    ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + kSecond, estimate));
    EXPECT_EQ(3u, estimate.counts.jumps);
    states.push_back(estimate.state(1));
  } while (std::next_permutation(stamps.begin(), stamps.end()));
  EXPECT_EQ(120u, states.size());
  EXPECT_EQ(states, std::vector<double>(120, states.front()));
}

TEST(LimitedJumpsTest, RefusesLimitsThatMakeNoSense) {
  EXPECT_THROW(LimitedJumps(test::example_law(), {-1, 10.0}), std::invalid_argument);
  EXPECT_THROW(LimitedJumps(test::example_law(), {0, 0.5}), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
