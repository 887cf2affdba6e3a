// Jumps that take effect later: the jump and its release are taken in together, however few events
// are kept, so that the estimate is a function of the events taken in.
#include <gtest/gtest.h>

#include "observer/delayed_jumps.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/allocation_counter.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

class DelayedJumpsLogTest : public ::testing::Test {
 protected:
  static Estimator make(std::size_t max_events) {
    Estimator::Options options;
    options.history = {100 * kSecond, max_events};
    options.sampling = {kSecond / 10, kSecond};
    options.future_tolerance = kSecond;
    return {std::make_shared<const DelayedJumps>(test::example_law()), options};
  }
  static EventReport take(Estimator& estimator, const OwnedEvent& event, Duration delay) {
    Event view = event.view();
    view.release = event.stamp + delay;
    return estimator.submit(view, kStart + 50 * kSecond);
  }
  /// A jump among samples, given in some order.
  static std::vector<OwnedEvent> events(const std::vector<int>& order) {
    const std::vector<OwnedEvent> all = {{kStart, EventKind::kInput, 0, {1.0, -0.5}},
                                         {kStart, EventKind::kJump, 0, {}},
                                         {kStart + kSecond / 4, EventKind::kSample, 0, {1.0}},
                                         {kStart + kSecond / 2, EventKind::kSample, 0, {-2.0}},
                                         {kStart + kSecond, EventKind::kSample, 1, {0.5, 2.0}}};
    std::vector<OwnedEvent> result;
    result.reserve(order.size());
    for (const int i : order) result.push_back(all[static_cast<std::size_t>(i)]);
    return result;
  }
  /// Whether the newest estimates are those of an observer that forgets nothing and was given the
  /// events taken in.
  static void expect_function_of_events(std::size_t max_events, const std::vector<int>& order,
                                        Duration delay) {
    Estimator small = make(max_events);
    Estimator large = make(1000);
    for (const OwnedEvent& event : events(order)) {
      if (!take(small, event, delay).used()) continue;
      EXPECT_TRUE(take(large, event, delay).used());
    }
    Estimate found = small.make_estimate();
    Estimate expected = large.make_estimate();
    for (const Duration after : {kSecond, 5 * kSecond / 2}) {
      ASSERT_EQ(Timeline::Query::kOk, small.estimate_at(kStart + after, found));
      large.estimate_at(kStart + after, expected);
      EXPECT_EQ(expected.state, found.state);
      EXPECT_EQ(expected.counts.events, found.counts.events);
      EXPECT_EQ(expected.counts.jumps, found.counts.jumps);
    }
  }
};

TEST_F(DelayedJumpsLogTest, TheJumpIsForgottenAtOnce) {
  for (const Duration delay : {Duration{0}, kSecond / 3, 2 * kSecond}) {
    expect_function_of_events(3, {2, 3, 4, 1}, delay);
  }
}

TEST_F(DelayedJumpsLogTest, OneEventIsKept) {
  for (const Duration delay : {Duration{0}, kSecond / 3, 2 * kSecond}) {
    expect_function_of_events(1, {0, 1, 2, 3, 4}, delay);
    expect_function_of_events(1, {1, 0, 3, 4, 2}, delay);
    expect_function_of_events(1, {3, 1, 4}, delay);
  }
}

TEST_F(DelayedJumpsLogTest, TheJumpComesLate) {
  for (const std::size_t max_events : {1u, 2u, 3u, 4u, 5u}) {
    for (const Duration delay : {Duration{0}, kSecond / 3, 2 * kSecond}) {
      expect_function_of_events(max_events, {0, 2, 1, 3, 4}, delay);
      expect_function_of_events(max_events, {0, 2, 3, 1, 4}, delay);
      expect_function_of_events(max_events, {0, 2, 3, 4, 1}, delay);
    }
  }
}

TEST_F(DelayedJumpsLogTest, AJumpIsRefusedWithItsRelease) {
  Estimator estimator = make(1);
  take(estimator, {kStart, EventKind::kSample, 0, {1.0}}, 0);
  take(estimator, {kStart + kSecond, EventKind::kSample, 0, {1.0}}, 0);
  Estimate before = estimator.make_estimate();
  estimator.estimate_at(kStart + 3 * kSecond, before);
  EXPECT_EQ(EventOutcome::kTooOld,
            take(estimator, {kStart, EventKind::kJump, 0, {}}, 2 * kSecond).outcome);
  Estimate after = estimator.make_estimate();
  estimator.estimate_at(kStart + 3 * kSecond, after);
  EXPECT_EQ(before.state, after.state);
  EXPECT_EQ(before.counts.events, after.counts.events);
}

TEST_F(DelayedJumpsLogTest, TheReportIsAboutTheJump) {
  Estimator estimator = make(100);
  take(estimator, {kStart, EventKind::kSample, 0, {1.0}}, 0);
  take(estimator, {kStart + 2 * kSecond, EventKind::kSample, 0, {1.0}}, 0);
  const OwnedEvent jump{kStart + kSecond, EventKind::kJump, 0, {}};
  const EventReport report = take(estimator, jump, kSecond / 2);
  EXPECT_EQ(EventOutcome::kUsedLate, report.outcome);
  EXPECT_EQ(1u, report.rewound);
  EXPECT_EQ(EventOutcome::kDuplicate, take(estimator, jump, kSecond / 2).outcome);
}

TEST_F(DelayedJumpsLogTest, AJumpOfBeforeOtherGainsIsReleasedWhereTheyBegin) {
  const OwnedEvent jump{kStart + kSecond, EventKind::kJump, 0, {}};
  Eigen::VectorXd expected;
  for (const bool is_late : {false, true}) {
    Estimator before = make(100);
    take(before, {kStart, EventKind::kSample, 0, {1.0}}, 0);
    if (!is_late) take(before, jump, kSecond);
    Estimator after = make(100);
    after.take_over(before, kStart + 2 * kSecond);
    if (is_late) {
      EXPECT_TRUE(take(after, jump, 3 * kSecond).used());
    }
    // Whenever it comes.
    EXPECT_EQ(EventOutcome::kDuplicate, after.submit(jump.view(), kStart + 9 * kSecond).outcome);
    Estimate found = after.make_estimate();
    ASSERT_EQ(Timeline::Query::kOk, after.estimate_at(kStart + 5 * kSecond / 2, found));
    if (!is_late) expected = found.state;
    EXPECT_EQ(expected, found.state);
  }
}

TEST_F(DelayedJumpsLogTest, AReleaseToComeOutlastsAPause) {
  Estimator estimator = make(100);
  take(estimator, {kStart, EventKind::kInput, 0, {1.0, -0.5}}, 0);
  take(estimator, {kStart + kSecond, EventKind::kJump, 0, {}}, kSecond);
  Estimate expected = estimator.make_estimate();
  estimator.estimate_at(kStart + 2 * kSecond, expected);
  estimator.resume(kStart + 3 * kSecond / 2);
  Estimate found = estimator.make_estimate();
  ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + 2 * kSecond, found));
  EXPECT_NEAR(0.0, (expected.state - found.state).norm(), 1e-9);
}

TEST_F(DelayedJumpsLogTest, AWithdrawnJumpReleasesNoOther) {
  OwnedEvent wrong{kStart + kSecond, EventKind::kJump, 0, {}};
  wrong.index = 5;
  OwnedEvent withdrawal = wrong;
  withdrawal.kind = EventKind::kWithdrawal;
  OwnedEvent right = wrong;
  right.index = 6;
  Estimator corrected = make(100);
  Estimator expected = make(100);
  for (Estimator* each : {&corrected, &expected}) {
    take(*each, {kStart, EventKind::kSample, 0, {1.0}}, 0);
    if (each == &corrected) {
      take(*each, wrong, kSecond / 4);
      take(*each, withdrawal, 0);
    }
    take(*each, right, kSecond / 2);
  }
  Estimate found = corrected.make_estimate();
  Estimate right_one = expected.make_estimate();
  for (const Duration after : {5 * kSecond / 4, 11 * kSecond / 8, 7 * kSecond / 4}) {
    ASSERT_EQ(Timeline::Query::kOk, corrected.estimate_at(kStart + after, found));
    ASSERT_EQ(Timeline::Query::kOk, expected.estimate_at(kStart + after, right_one));
    EXPECT_NEAR(0.0, (right_one.state - found.state).head(3).norm(), 1e-9) << after;
  }
}

TEST_F(DelayedJumpsLogTest, NothingIsAllocated) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  for (const std::size_t max_events : {1u, 2u}) {
    Estimator estimator = make(max_events);
    const std::vector<OwnedEvent> all = events({1, 0, 3, 4, 2});
    const std::size_t before = test::allocations();
    for (const OwnedEvent& event : all) take(estimator, event, kSecond / 3);
    EXPECT_EQ(before, test::allocations());
  }
}

}  // namespace
}  // namespace sampled_data_observers
