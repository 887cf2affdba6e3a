#include "sampled_data_observers/hybrid/timeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "support/allocation_counter.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

struct Snapshot {
  Timeline::Query query = Timeline::Query::kNoEvent;
  std::vector<double> state;
  std::uint64_t events = 0;
  std::uint64_t samples = 0;
  std::uint64_t jumps = 0;
  std::uint64_t digest = 0;
};

Snapshot snapshot(const Timeline& timeline, const HybridSystem& system, Stamp stamp) {
  Snapshot result;
  Eigen::VectorXd state = Eigen::VectorXd::Zero(system.state_size());
  EventCounts counts;
  result.query = timeline.state_at(stamp, state, counts);
  result.state.assign(state.data(), state.data() + state.size());
  result.events = counts.events;
  result.samples = counts.samples;
  result.jumps = counts.jumps;
  result.digest = counts.digest;
  return result;
}

bool operator==(const Snapshot& a, const Snapshot& b) {
  return a.query == b.query && a.events == b.events && a.samples == b.samples &&
         a.jumps == b.jumps && a.digest == b.digest && a.state.size() == b.state.size() &&
         std::memcmp(a.state.data(), b.state.data(), a.state.size() * sizeof(double)) == 0;
}

std::vector<Snapshot> snapshots(const Timeline& timeline, const HybridSystem& system) {
  std::vector<Snapshot> result;
  for (Stamp stamp = kStart - kSecond / 10; stamp < kStart + 3 * kSecond; stamp += 37'000'123) {
    result.push_back(snapshot(timeline, system, stamp));
  }
  return result;
}

class TimelineTest : public ::testing::Test {
 protected:
  Timeline make(Duration history = 10 * kSecond, std::size_t max_events = 200) const {
    return Timeline(law_, {history, max_events});
  }
  OwnedEvent sample(Stamp stamp, double value = 1.0) const {
    return {stamp, EventKind::kSample, 0, {value}};
  }

  std::shared_ptr<const HybridSystem> law_ = test::example_law();
};

TEST_F(TimelineTest, EveryOrderOfArrivalGivesTheSameBits) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::mt19937_64 generator(seed);
    std::vector<OwnedEvent> events = test::random_events(generator, 30, kStart, 2 * kSecond);
    Timeline reference = make();
    for (const OwnedEvent& event : events) reference.insert(event.view());
    const std::vector<Snapshot> expected = snapshots(reference, *law_);
    for (int permutation = 0; permutation < 10; ++permutation) {
      std::shuffle(events.begin(), events.end(), generator);
      Timeline timeline = make();
      for (const OwnedEvent& event : events) timeline.insert(event.view());
      const std::vector<Snapshot> found = snapshots(timeline, *law_);
      EXPECT_TRUE(expected == found);
    }
  }
}

TEST_F(TimelineTest, EveryOrderOfEventsWithOneStampGivesTheSameBits) {
  std::vector<OwnedEvent> events = {{kStart, EventKind::kSample, 0, {1.0}},
                                    {kStart, EventKind::kSample, 0, {2.0}},
                                    {kStart, EventKind::kSample, 1, {0.5, 3.0}},
                                    {kStart, EventKind::kJump, 0, {}},
                                    {kStart, EventKind::kInput, 0, {1.0, 0.0}}};
  const auto less = [](const OwnedEvent& a, const OwnedEvent& b) {
    return compare(a.view(), b.view()) < 0;
  };
  std::sort(events.begin(), events.end(), less);
  Timeline reference = make();
  for (const OwnedEvent& event : events) reference.insert(event.view());
  const Snapshot expected = snapshot(reference, *law_, kStart + kSecond);
  do {
    Timeline timeline = make();
    for (const OwnedEvent& event : events) timeline.insert(event.view());
    EXPECT_TRUE(expected == snapshot(timeline, *law_, kStart + kSecond));
  } while (std::next_permutation(events.begin(), events.end(), less));
}

TEST_F(TimelineTest, BeginsAtAStatedStamp) {
  Timeline timeline = make();
  timeline.begin(kStart);
  EXPECT_EQ(kStart, timeline.earliest());
  EXPECT_EQ(kStart, timeline.earliest_insertion());
  Eigen::VectorXd initial(law_->state_size());
  law_->initialize(initial.data());
  const Snapshot alone = snapshot(timeline, *law_, kStart);
  EXPECT_EQ(std::vector<double>(initial.data(), initial.data() + initial.size()), alone.state);
  EXPECT_EQ(Timeline::Query::kBeforeStart, snapshot(timeline, *law_, kStart - 1).query);
  EXPECT_EQ(Timeline::Insertion::kBeforeWindow,
            timeline.insert(sample(kStart - 1).view()).insertion);
  EXPECT_EQ(Timeline::Insertion::kAppended, timeline.insert(sample(kStart).view()).insertion);
  EXPECT_EQ(1u, snapshot(timeline, *law_, kStart).samples);
  // From there on as if it had begun with that event.
  Timeline by_event = make();
  by_event.insert(sample(kStart).view());
  EXPECT_TRUE(snapshots(by_event, *law_) == snapshots(timeline, *law_));
  timeline.clear();
  EXPECT_EQ(std::nullopt, timeline.earliest());
}

TEST_F(TimelineTest, AJumpThatIsTakenBackWasNeverTold) {
  const OwnedEvent first = {kStart, EventKind::kJump, 0, {}, std::nullopt, 1};
  const OwnedEvent wrong = {kStart + kSecond, EventKind::kJump, 0, {}, std::nullopt, 2};
  const OwnedEvent other = {kStart + kSecond, EventKind::kJump, 0, {}, std::nullopt, 3};
  OwnedEvent back = wrong;
  back.kind = EventKind::kWithdrawal;
  Timeline never = make();
  for (const OwnedEvent& event : {first, other}) never.insert(event.view());
  for (const bool comes_first : {false, true}) {
    Timeline timeline = make();
    timeline.insert(first.view());
    if (comes_first) {
      EXPECT_EQ(Effect::kNoSuchJump, timeline.insert(back.view()).effect);
      EXPECT_EQ(Effect::kWithdrawn, timeline.insert(wrong.view()).effect);
    } else {
      EXPECT_EQ(Effect::kApplied, timeline.insert(wrong.view()).effect);
      EXPECT_EQ(Effect::kWithdrawal, timeline.insert(back.view()).effect);
    }
    EXPECT_FALSE(timeline.has_jump(kStart, kStart + 2 * kSecond));
    EXPECT_EQ(Timeline::Insertion::kDuplicate, timeline.insert(back.view()).insertion);
    EXPECT_EQ(Effect::kApplied, timeline.insert(other.view()).effect);
    EXPECT_TRUE(timeline.has_jump(kStart, kStart + 2 * kSecond));
    const Snapshot found = snapshot(timeline, *law_, kStart + 2 * kSecond);
    const Snapshot expected = snapshot(never, *law_, kStart + 2 * kSecond);
    EXPECT_EQ(expected.state, found.state);
    EXPECT_EQ(2u, found.jumps);
    EXPECT_EQ(4u, found.events);
  }
}

TEST_F(TimelineTest, WithoutNumbersAModeIsTakenBack) {
  OwnedEvent back = {kStart, EventKind::kWithdrawal, 0, {}, 2.0, 0};
  const OwnedEvent into_2 = {kStart, EventKind::kJump, 0, {}, 2.0, 0};
  const OwnedEvent into_1 = {kStart, EventKind::kJump, 0, {}, 1.0, 0};
  OwnedEvent counted = into_2;
  counted.index = 5;
  OwnedEvent later = into_2;
  ++later.stamp;
  EXPECT_TRUE(withdraws(back.view(), into_2.view()));
  for (const OwnedEvent& kept : {into_1, counted, later, back}) {
    EXPECT_FALSE(withdraws(back.view(), kept.view()));
  }
  back.index = 5;
  back.mode = 1.0;
  EXPECT_TRUE(withdraws(back.view(), counted.view()));
  EXPECT_LT(compare(back.view(), into_1.view()), 0);
  const OwnedEvent input = {kStart, EventKind::kInput, 0, {1.0, 0.0}};
  EXPECT_LT(compare(input.view(), back.view()), 0);
}

TEST_F(TimelineTest, KnowsOfJumpsAfterAStamp) {
  Timeline timeline = make();
  EXPECT_FALSE(timeline.has_jump(0, kStart));
  const OwnedEvent jump = {kStart + 10, EventKind::kJump, 0, {}};
  timeline.insert(sample(kStart).view());
  timeline.insert(jump.view());
  timeline.insert(sample(kStart + 20).view());
  EXPECT_TRUE(timeline.has_jump(kStart + 9, kStart + 10));
  EXPECT_TRUE(timeline.has_jump(kStart - 5, kStart + 100));
  EXPECT_FALSE(timeline.has_jump(kStart + 10, kStart + 100));
  EXPECT_FALSE(timeline.has_jump(kStart - 5, kStart + 9));
}

/// Remembers the last value to the bit.
class LastValue : public HybridSystem {
 public:
  LastValue() {
    state_layout().vector(1);
    facts().max_event_size = 1;
    facts().sensors = 1;
  }

  bool accepts(const Event& event) const override { return event.size == 1; }
  void initialize(double* state) const override { *state = 1.0; }
  void flow(Duration, double*, double*) const override {}
  Effect reset(const Event& event, double* state, double*) const override {
    *state = *event.values;
    return Effect::kApplied;
  }
};

TEST_F(TimelineTest, ASignedZeroOfTheSameStampGivesTheSameBitsWhicheverComesFirst) {
  const auto system = std::make_shared<const LastValue>();
  const auto after = [&](const std::vector<double>& arrived) {
    Timeline timeline(system, {10 * kSecond, 200});
    for (const double value : arrived) timeline.insert(sample(kStart, value).view());
    return snapshot(timeline, *system, kStart + kSecond);
  };
  const Snapshot expected = after({0.0, -0.0});
  EXPECT_FALSE(std::signbit(expected.state.front()));
  EXPECT_TRUE(expected == after({-0.0, 0.0}));
  EXPECT_TRUE(expected == after({-0.0}));
  EXPECT_EQ(1u, expected.events);
}

TEST_F(TimelineTest, QueriesChangeNothing) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::mt19937_64 generator(seed);
    const std::vector<OwnedEvent> events = test::random_events(generator, 40, kStart, 2 * kSecond);
    std::uniform_int_distribution<Stamp> any(kStart - kSecond, kStart + 4 * kSecond);
    Timeline quiet = make();
    Timeline asked = make();
    for (const OwnedEvent& event : events) {
      quiet.insert(event.view());
      asked.insert(event.view());
      for (int i = 0; i < 5; ++i) snapshot(asked, *law_, any(generator));
    }
    const std::vector<Snapshot> expected = snapshots(quiet, *law_);
    const std::vector<Snapshot> found = snapshots(asked, *law_);
    EXPECT_TRUE(expected == found);
  }
}

TEST_F(TimelineTest, TheEstimateRestsOnEventsUpToItsStampOnly) {
  Timeline timeline = make();
  timeline.insert(sample(kStart).view());
  const Snapshot before = snapshot(timeline, *law_, kStart + kSecond);
  timeline.insert(sample(kStart + kSecond + 1).view());
  EXPECT_TRUE(before == snapshot(timeline, *law_, kStart + kSecond));
  EXPECT_EQ(1u, before.events);
  EXPECT_EQ(2u, snapshot(timeline, *law_, kStart + kSecond + 1).events);
}

TEST_F(TimelineTest, AtOneStampInputComesFirstThenJumpThenSample) {
  const OwnedEvent first = sample(kStart);
  const Stamp now = kStart + kSecond / 3;
  const OwnedEvent input{now, EventKind::kInput, 0, {5.0, -2.0}};
  const OwnedEvent jump{now, EventKind::kJump, 0, {}};
  const OwnedEvent measured = sample(now, 0.25);

  Eigen::VectorXd expected(law_->state_size());
  Eigen::VectorXd workspace(law_->workspace_size());
  law_->initialize(expected.data());
  law_->reset(first.view(), expected.data(), workspace.data());
  law_->flow(now - kStart, expected.data(), workspace.data());
  for (const OwnedEvent& event : {input, jump, measured}) {
    law_->reset(event.view(), expected.data(), workspace.data());
  }

  Timeline timeline = make();
  for (const OwnedEvent& event : {measured, first, jump, input}) timeline.insert(event.view());
  const Snapshot found = snapshot(timeline, *law_, now);
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(expected(i), found.state[static_cast<std::size_t>(i)]);
  }
}

TEST_F(TimelineTest, ALateEventRewindsTheLaterOnes) {
  Timeline timeline = make();
  for (int i : {0, 1, 2, 4, 5}) timeline.insert(sample(kStart + i * kSecond / 10).view());
  const Timeline::InsertReport report = timeline.insert(sample(kStart + 3 * kSecond / 10).view());
  EXPECT_EQ(Timeline::Insertion::kRewound, report.insertion);
  EXPECT_EQ(2u, report.rewound);
  EXPECT_EQ(kStart + 2 * kSecond / 10, *report.previous);
}

TEST_F(TimelineTest, ADuplicateChangesNothing) {
  Timeline timeline = make();
  timeline.insert(sample(kStart).view());
  timeline.insert(sample(kStart + kSecond).view());
  const std::vector<Snapshot> before = snapshots(timeline, *law_);
  EXPECT_EQ(Timeline::Insertion::kDuplicate, timeline.insert(sample(kStart).view()).insertion);
  const std::vector<Snapshot> after = snapshots(timeline, *law_);
  EXPECT_TRUE(before == after);
}

TEST_F(TimelineTest, AnEventBeforeTheWindowIsDropped) {
  Timeline timeline = make(kSecond);
  timeline.insert(sample(kStart).view());
  timeline.insert(sample(kStart + 2 * kSecond).view());
  const Snapshot before = snapshot(timeline, *law_, kStart + 2 * kSecond);
  EXPECT_EQ(Timeline::Insertion::kBeforeWindow,
            timeline.insert(sample(kStart + kSecond - 1).view()).insertion);
  EXPECT_TRUE(before == snapshot(timeline, *law_, kStart + 2 * kSecond));
  EXPECT_EQ(Timeline::Insertion::kRewound,
            timeline.insert(sample(kStart + kSecond).view()).insertion);
}

TEST_F(TimelineTest, ForgettingOldEventsChangesNoEstimate) {
  std::mt19937_64 generator(7);
  std::vector<OwnedEvent> events = test::random_events(generator, 100, kStart, 2 * kSecond);
  std::sort(events.begin(), events.end(), [](const OwnedEvent& a, const OwnedEvent& b) {
    return compare(a.view(), b.view()) < 0;
  });
  Timeline all = make();
  Timeline by_time = make(kSecond / 4);
  Timeline by_number = make(10 * kSecond, 5);
  for (const OwnedEvent& event : events) {
    for (Timeline* timeline : {&all, &by_time, &by_number}) timeline->insert(event.view());
    EXPECT_TRUE(snapshot(all, *law_, event.stamp) == snapshot(by_time, *law_, event.stamp));
    EXPECT_TRUE(snapshot(all, *law_, event.stamp) == snapshot(by_number, *law_, event.stamp));
  }
  EXPECT_EQ(100u, all.size());
  EXPECT_EQ(5u, by_number.size());
  EXPECT_LT(by_time.size(), 100u);
  EXPECT_EQ(Timeline::Query::kBeforeWindow, snapshot(by_number, *law_, kStart).query);
}

TEST_F(TimelineTest, TheStateBeginsWithTheFirstEvent) {
  Timeline timeline = make();
  EXPECT_EQ(Timeline::Query::kNoEvent, snapshot(timeline, *law_, kStart).query);
  EXPECT_FALSE(timeline.earliest());
  timeline.insert(sample(kStart).view());
  EXPECT_EQ(Timeline::Query::kBeforeStart, snapshot(timeline, *law_, kStart - 1).query);
  EXPECT_EQ(Timeline::Query::kOk, snapshot(timeline, *law_, kStart).query);
  EXPECT_EQ(kStart, *timeline.earliest());
  timeline.insert(sample(kStart - kSecond).view());
  EXPECT_EQ(kStart - kSecond, *timeline.earliest());
}

TEST_F(TimelineTest, ARestartForgetsAndRefusesWhatCameBefore) {
  Timeline timeline = make();
  timeline.insert(sample(kStart).view());
  Eigen::VectorXd state(law_->state_size());
  law_->initialize(state.data());
  state(0) = 1.0;
  timeline.restart(kStart + kSecond, state);
  const Snapshot found = snapshot(timeline, *law_, kStart + kSecond);
  EXPECT_EQ(0u, found.events);
  EXPECT_EQ(1.0, found.state.front());
  EXPECT_EQ(Timeline::Query::kBeforeStart, snapshot(timeline, *law_, kStart).query);
  EXPECT_EQ(Timeline::Insertion::kBeforeWindow,
            timeline.insert(sample(kStart + kSecond).view()).insertion);
  EXPECT_EQ(Timeline::Insertion::kAppended,
            timeline.insert(sample(kStart + kSecond + 1).view()).insertion);
}

TEST_F(TimelineTest, WhatWouldOverflowIsSkippedAndTheEstimateStaysFinite) {
  constexpr double kHuge = std::numeric_limits<double>::max();
  Timeline timeline = make();
  timeline.insert(sample(kStart).view());
  const Snapshot before = snapshot(timeline, *law_, kStart + kSecond);
  const OwnedEvent bad{kStart + kSecond, EventKind::kSample, 1, {kHuge, -kHuge}};
  const OwnedEvent worse{kStart + kSecond + 1, EventKind::kSample, 0, {-kHuge}};
  timeline.insert(bad.view());
  EXPECT_EQ(Effect::kNotFinite, timeline.insert(worse.view()).effect);
  const Snapshot after = snapshot(timeline, *law_, kStart + kSecond + 1);
  for (const double value : after.state) EXPECT_TRUE(std::isfinite(value));
  EXPECT_EQ(before.events + 2, after.events);
  EXPECT_LT(after.samples, after.events);  // what had no effect is an event, but no sample
}

/// x' = 100 x: a flow of some seconds is not finite.
std::shared_ptr<const HybridSystem> overflowing_law() {
  LinearPlantDescription plant;
  plant.state_names = {"x"};
  plant.A = Eigen::MatrixXd::Constant(1, 1, 100.0);
  plant.B = Eigen::MatrixXd::Zero(1, 0);
  plant.sensors = {{"s", Eigen::MatrixXd::Identity(1, 1), {false}}};
  return std::make_shared<const ConstantGainObserver>(
      ObserverContext{make_linear_plant(plant), Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(0)},
      std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Identity(1, 1)});
}

TEST_F(TimelineTest, AnOverflowingFlowHoldsTheLastFiniteState) {
  const auto law = overflowing_law();
  Timeline timeline(law, {kSecond, 10});
  timeline.insert(sample(kStart, 2.0).view());
  const Snapshot held = snapshot(timeline, *law, kStart + 100 * kSecond);
  EXPECT_EQ(Timeline::Query::kHeld, held.query);
  EXPECT_EQ(2.0, held.state.front());
  EXPECT_EQ(Effect::kApplied, timeline.insert(sample(kStart + 100 * kSecond, 3.0).view()).effect);
  const Snapshot corrected = snapshot(timeline, *law, kStart + 100 * kSecond);
  EXPECT_EQ(Timeline::Query::kHeld, corrected.query);
  EXPECT_EQ(3.0, corrected.state.front());
  EXPECT_EQ(Timeline::Query::kOk, snapshot(timeline, *law, kStart + 100 * kSecond + 1).query);
}

TEST_F(TimelineTest, AStateIsHeldUntilAFlowOverSomeTimeSucceeds) {
  const auto law = overflowing_law();
  const auto query = [&](const Timeline& timeline, Stamp stamp) {
    return snapshot(timeline, *law, stamp).query;
  };
  const Stamp quiet = kStart + 100 * kSecond;
  for (const std::size_t max_events : {1u, 2u, 10u}) {
    Timeline timeline(law, {1000 * kSecond, max_events});
    timeline.insert(sample(kStart).view());
    EXPECT_EQ(Timeline::Query::kOk, query(timeline, kStart));
    for (int i = 0; i < 3; ++i) timeline.insert(sample(quiet, i).view());
    EXPECT_EQ(Timeline::Query::kHeld, query(timeline, quiet)) << max_events;
    EXPECT_EQ(Timeline::Query::kOk, query(timeline, quiet + 1)) << max_events;
    timeline.insert(sample(quiet + 1).view());
    EXPECT_EQ(Timeline::Query::kOk, query(timeline, quiet + 1)) << max_events;
    timeline.insert(sample(quiet + 100 * kSecond).view());
    EXPECT_EQ(Timeline::Query::kHeld, query(timeline, quiet + 100 * kSecond)) << max_events;
  }
}

TEST_F(TimelineTest, AStartFromAHeldStateIsHeld) {
  const auto law = overflowing_law();
  Timeline timeline(law, {1000 * kSecond, 10});
  timeline.insert(sample(kStart).view());
  Eigen::VectorXd state(law->state_size());
  law->initialize(state.data());
  for (const bool held : {true, false}) {
    const auto expected = held ? Timeline::Query::kHeld : Timeline::Query::kOk;
    timeline.restart(kStart, state, held);
    EXPECT_EQ(expected, snapshot(timeline, *law, kStart).query);
    timeline.rebase(kStart + 1, state, held);
    EXPECT_EQ(expected, snapshot(timeline, *law, kStart + 1).query);
    EXPECT_EQ(Timeline::Query::kOk, snapshot(timeline, *law, kStart + 2).query);
  }
}

TEST_F(TimelineTest, TwoEventsAreTakenInTogetherOrNotAtAll) {
  const OwnedEvent first{kStart, EventKind::kJump, 0, {}};
  Timeline full = make(10 * kSecond, 1);
  Timeline all = make();
  for (Timeline* timeline : {&full, &all}) {
    timeline->insert(sample(kStart + kSecond).view());
    const Timeline::InsertReport report = timeline->insert(first.view(), sample(kStart).view());
    EXPECT_EQ(Timeline::Insertion::kRewound, report.insertion);
    EXPECT_EQ(1u, report.rewound);
  }
  EXPECT_EQ(Timeline::Insertion::kBeforeWindow,
            full.insert(first.view(), sample(kStart + 2 * kSecond).view()).insertion);
  EXPECT_TRUE(snapshot(all, *law_, kStart + 3 * kSecond) ==
              snapshot(full, *law_, kStart + 3 * kSecond));
}

TEST_F(TimelineTest, ThePreviousOneIsThatOfAnEarlierStamp) {
  Timeline timeline = make();
  for (int i = 0; i < 9; ++i) {
    EXPECT_FALSE(timeline.insert(sample(kStart, i).view()).previous) << i;
  }
  const OwnedEvent jump{kStart + 1, EventKind::kJump, 0, {}};
  timeline.insert(jump.view());
  for (const int i : {4, 3, 5, 2, 6, 1, 7}) {
    EXPECT_EQ(kStart, *timeline.insert(sample(kStart + 2, i).view()).previous) << i;
  }
  EXPECT_EQ(kStart + 2, *timeline.insert(sample(kStart + 3).view()).previous);
}

TEST_F(TimelineTest, NothingIsAllocatedAfterConstruction) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  std::mt19937_64 generator(3);
  const std::vector<OwnedEvent> events = test::random_events(generator, 500, kStart, 5 * kSecond);
  Timeline timeline = make(2 * kSecond, 100);
  Eigen::VectorXd state(law_->state_size());
  EventCounts counts;
  const std::size_t before = test::allocations();
  for (const OwnedEvent& event : events) {
    timeline.insert(event.view());
    timeline.state_at(event.stamp + kSecond / 7, state, counts);
  }
  timeline.restart(kStart, state);
  EXPECT_EQ(before, test::allocations());
}

TEST_F(TimelineTest, RefusesLimitsThatMakeNoSense) {
  EXPECT_THROW(make(0), std::invalid_argument);
  EXPECT_THROW(make(kSecond, 0), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
