// Jumps that who detects them counts, takes back, or tells at other times than configured: what is
// lost is noticed, and what was taken back was never told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "sampled_data_observers/observer/plant_observer.h"
#include "sampled_data_observers/runtime/observer_runtime.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::Fault;
using test::kSecond;
using test::kStart;
using test::OwnedEvent;
using test::parse;

const char kPlant[] = R"(
observer: SynchronizedObserver
plant: {states: [x, v], A: [[0, 1], [-1, 0]], jump_map: {A_d: [[1, 0], [0, -0.8]], b_d: [0.1, 0]}}
sensors: {s: {C: [[1, 0]], measured: at_jumps}}
gains: {L_d: [[0.5], [0.1]]}
initial_estimate: {x: 1, v: 0}
history: {duration: 100, max_events: 2000}
)";

class CountedJumpsTest : public ::testing::Test {
 protected:
  static ObserverConfig configure(const std::string& jumps = "{}") {
    return parse(kPlant + ("jumps: " + jumps));
  }

  static OwnedEvent jump(double seconds, std::uint32_t index = 0) {
    OwnedEvent event{kStart + from_seconds(seconds), EventKind::kJump, 0, {0.25}};
    event.index = index;
    return event;
  }
  static OwnedEvent withdrawal(const OwnedEvent& of) {
    OwnedEvent event = of;
    event.kind = EventKind::kWithdrawal;
    event.values.clear();
    return event;
  }

  /// A state at which events of before stand.
  class Run {
   public:
    explicit Run(const ObserverConfig& config)
        : runtime_(config), estimate_(runtime_.estimator().make_estimate()) {}

    EventReport take(const OwnedEvent& event) {
      return runtime_.receive(event.view(), kStart + 50 * kSecond);
    }
    const Estimate& at(double seconds) {
      EXPECT_EQ(Timeline::Query::kOk,
                runtime_.estimator().estimate_at(kStart + from_seconds(seconds), estimate_));
      return estimate_;
    }
    double lost_at(double seconds) { return law().skipped_jumps(at(seconds).state.data()); }
    void enable(bool enabled, double seconds) {
      runtime_.set_enabled(enabled, kStart + from_seconds(seconds));
    }
    bool is_before_gap(double seconds) const {
      return runtime_.estimator().is_before_gap(kStart + from_seconds(seconds));
    }
    double violations_at(double seconds) {
      return law().dwell_violations(at(seconds).state.data());
    }

   private:
    const ObserverLaw& law() const { return runtime_.estimator().law(); }

    ObserverRuntime runtime_;
    Estimate estimate_;
  };
};

TEST_F(CountedJumpsTest, WhatIsTakenBackWasNeverTold) {
  const OwnedEvent wrong = jump(2.0, 2);
  Run never(configure());
  never.take(jump(1.0, 1));
  never.take(jump(3.0, 3));
  const Eigen::VectorXd expected = never.at(4.0).state.head(2);
  for (const bool comes_first : {false, true}) {
    Run run(configure());
    run.take(jump(1.0, 1));
    if (comes_first) {
      EXPECT_EQ(EventOutcome::kNoSuchJump, run.take(withdrawal(wrong)).outcome);
      EXPECT_EQ(EventOutcome::kWithdrawn, run.take(wrong).outcome);
      run.take(jump(3.0, 3));
    } else {
      run.take(jump(3.0, 3));
      EXPECT_EQ(EventOutcome::kUsedLate, run.take(wrong).outcome);
      const EventReport report = run.take(withdrawal(wrong));
      EXPECT_EQ(EventOutcome::kTakenBack, report.outcome);
      EXPECT_EQ(2u, report.rewound);
      EXPECT_TRUE(report.used());
    }
    EXPECT_NEAR(0.0, (run.at(4.0).state.head(2) - expected).norm(), 1e-12);
    EXPECT_EQ(2u, run.at(4.0).counts.jumps);
    EXPECT_EQ(0.0, run.lost_at(4.0));
    EXPECT_EQ(EventOutcome::kDuplicate, run.take(withdrawal(wrong)).outcome);
  }
  EXPECT_EQ(1.0, never.lost_at(4.0));
}

TEST_F(CountedJumpsTest, ATooOldWithdrawalIsAnsweredAsSuch) {
  Run run(parse(test::replaced(kPlant, "duration: 100", "duration: 1")));
  const OwnedEvent wrong = jump(1.0, 1);
  run.take(wrong);
  run.take(jump(4.0, 2));
  EXPECT_EQ(EventOutcome::kTooOld, run.take(withdrawal(wrong)).outcome);
  EXPECT_EQ(2u, run.at(4.0).counts.jumps);
}

TEST_F(CountedJumpsTest, NothingIsAllocatedForThem) {
  Run run(
      configure("{dwell_time: [0.5, 2], average_dwell_time: {tau: 1, N0: 2}, "
                "rest: {set: [x], margin: 0.1, state: {x: 0}}}"));
  std::vector<OwnedEvent> events;
  for (std::uint32_t k = 1; k < 20; ++k) {
    events.push_back(jump(0.7 * k, k));
    events.push_back(withdrawal(jump(0.7 * (k + k % 2), k)));
  }
  const std::size_t before = test::allocations();
  for (const OwnedEvent& event : events) run.take(event);
  EXPECT_EQ(before, test::allocations());
  EXPECT_LT(run.at(20.0).counts.jumps, 19u);
}

TEST_F(CountedJumpsTest, NumbersLeftOutAreJumpsLost) {
  Run run(configure());
  run.take(jump(1.0, 5));  // the observer came later
  EXPECT_EQ(0.0, run.lost_at(1.0));
  run.take(jump(4.0, 8));
  EXPECT_EQ(0.0, run.lost_at(3.0));
  EXPECT_EQ(2.0, run.lost_at(4.0));
  run.take(jump(2.0, 6));  // it was only late
  EXPECT_EQ(1.0, run.lost_at(4.0));
  run.take(jump(5.0, 7));  // and this one stamped too late
  EXPECT_EQ(1.0, run.lost_at(4.0));
  EXPECT_EQ(0.0, run.lost_at(5.0));
  run.take(jump(6.0, 9));
  run.take(jump(7.0));     // which nobody counted
  run.take(jump(8.0, 1));  // the detector was started again
  run.take(jump(9.0, 2));
  EXPECT_EQ(0.0, run.lost_at(9.0));
  run.take(jump(10.0, 4));
  EXPECT_EQ(1.0, run.lost_at(10.0));
}

TEST_F(CountedJumpsTest, ANumberThatWasRejectedWasTold) {
  Run run(configure());
  run.take(jump(1.0, 1));
  run.enable(false, 1.5);
  EXPECT_EQ(EventOutcome::kDisabled, run.take(jump(2.0, 2)).outcome);
  EXPECT_EQ(EventOutcome::kDisabled, run.take(jump(2.2, 5)).outcome);
  EXPECT_TRUE(run.is_before_gap(2.1));
  EXPECT_FALSE(run.is_before_gap(1.9 - 1.0));
  run.enable(true, 2.5);
  EXPECT_EQ(2.0, run.lost_at(2.5));  // 3 and 4, of before
  run.take(jump(3.0, 6));
  EXPECT_EQ(2.0, run.lost_at(3.0));
  EXPECT_EQ(EventOutcome::kUsed, run.take(jump(4.0, 5)).outcome);  // told again, and taken now
  EXPECT_EQ(2u, run.at(4.0).counts.jumps);
}

TEST_F(CountedJumpsTest, ANumberThatIsTooOldFillsItsPlaceAndBeginsNoCount) {
  Run run(parse(test::replaced(kPlant, "max_events: 2000", "max_events: 2")));
  run.take(jump(1.0, 1));
  for (const std::uint32_t k : {3, 4, 5}) run.take(jump(k, k));
  EXPECT_EQ(1.0, run.lost_at(5.0));
  EXPECT_EQ(EventOutcome::kTooOld, run.take(jump(2.0, 2)).outcome);
  EXPECT_EQ(0.0, run.lost_at(5.0));
  EXPECT_EQ(EventOutcome::kTooOld, run.take(jump(3.0, 3)).outcome);  // told again
  run.take(jump(6.0, 6));
  EXPECT_EQ(0.0, run.lost_at(6.0));
}

TEST_F(CountedJumpsTest, ANumberWhoseJumpWouldOverflowWasTold) {
  Run run(parse(test::replaced(kPlant, "[[1, 0], [0, -0.8]]", "[[1e90, 0], [0, 1]]")));
  EXPECT_EQ(EventOutcome::kUsed, run.take(jump(1.0, 1)).outcome);
  EXPECT_EQ(EventOutcome::kWouldOverflow, run.take(jump(2.0, 2)).outcome);
  run.take(withdrawal(jump(3.0, 3)));
  EXPECT_EQ(0.0, run.lost_at(3.0));
}

TEST_F(CountedJumpsTest, ARejectedNumberBeginsNoEstimate) {
  ObserverRuntime runtime(configure());
  runtime.set_enabled(false, kStart);
  runtime.receive(jump(1.0, 7).view(), kStart + 2 * kSecond);
  EXPECT_FALSE(runtime.estimator().earliest().has_value());
}

TEST_F(CountedJumpsTest, ARejectedNumberCountsInWhateverOrderItComes) {
  OwnedEvent rejected = jump(2.0, 2);
  rejected.values = {std::numeric_limits<double>::quiet_NaN()};
  OwnedEvent of_before = jump(0.5, 7);
  of_before.values = rejected.values;
  std::vector<OwnedEvent> events = {of_before, rejected, jump(1.0, 1), jump(3.0, 3)};
  std::vector<std::size_t> order = {0, 1, 2, 3};
  std::optional<std::uint64_t> digest;
  do {
    Run run(configure());
    for (const std::size_t i : order) run.take(events[i]);
    EXPECT_EQ(0.0, run.lost_at(3.0));  // 2 was told; 7, of before the estimate, plays no part
    const std::uint64_t found = run.at(3.0).counts.digest;
    EXPECT_EQ(digest.value_or(found), found);
    digest = found;
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_F(CountedJumpsTest, ARejectedNumberOfBeforeOtherGainsCountsThere) {
  const ObserverConfig config = configure();
  Estimator former(config.law, config.options);
  OwnedEvent rejected = jump(2.0, 2);
  rejected.values = {std::numeric_limits<double>::quiet_NaN()};
  const Stamp now = kStart + 50 * kSecond;
  former.submit(rejected.view(), now);
  Estimator estimator(config.law, config.options);
  estimator.take_over(former, now);
  for (const std::uint32_t k : {1, 3}) estimator.submit(jump(k, k).view(), now);
  Estimate estimate = estimator.make_estimate();
  ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + 3 * kSecond, estimate));
  EXPECT_EQ(0.0, estimator.law().skipped_jumps(estimate.state.data()));
}

TEST_F(CountedJumpsTest, ALowerNumberThatIsNotMissingBeginsANewCount) {
  Run restarted(configure());
  restarted.take(jump(1.0, 57));
  restarted.take(jump(2.0, 2));  // of a detector that was started again, and lost its first
  EXPECT_EQ(1.0, restarted.lost_at(2.0));
  restarted.take(jump(3.0, 4));
  EXPECT_EQ(2.0, restarted.lost_at(3.0));
  Run told_twice(configure());
  told_twice.take(jump(1.0, 3));
  told_twice.take(jump(2.0, 5));
  told_twice.take(jump(3.0, 3));
  EXPECT_EQ(3.0, told_twice.lost_at(3.0));
  Run blinded(configure());
  blinded.take(jump(1.0, 4'000'000'000));
  blinded.take(jump(2.0, 5));
  blinded.take(jump(3.0, 7));
  EXPECT_EQ(5.0, blinded.lost_at(3.0));
}

TEST_F(CountedJumpsTest, EachMissingNumberFillsItsOwnPlaceOnce) {
  Run run(configure());
  run.take(jump(1.0, 1));
  run.take(jump(2.0, 3));
  run.take(jump(3.0, 5));
  EXPECT_EQ(2.0, run.lost_at(3.0));
  run.take(jump(4.0, 4));
  run.take(jump(5.0, 2));
  EXPECT_EQ(0.0, run.lost_at(5.0));
  run.take(jump(6.0, 4));
  EXPECT_EQ(3.0, run.lost_at(6.0));
  Run far(configure());
  far.take(jump(1.0, 1));
  far.take(jump(2.0, 100));
  far.take(jump(3.0, 48));  // the lowest that is known to be missing
  EXPECT_EQ(97.0, far.lost_at(3.0));
  far.take(jump(4.0, 152));
  far.take(jump(5.0, 101));
  EXPECT_EQ(97.0 + 50.0, far.lost_at(5.0));
}

TEST_F(CountedJumpsTest, RefusedAndWithdrawnJumpsAreNotLost) {
  Run run(configure("{min_separation: 0.1}"));
  run.take(jump(1.0, 1));
  EXPECT_EQ(EventOutcome::kTooFrequent, run.take(jump(1.05, 2)).outcome);
  run.take(jump(2.0, 3));
  run.take(withdrawal(jump(3.0, 4)));
  run.take(jump(4.0, 5));
  EXPECT_EQ(0.0, run.lost_at(4.0));
}

TEST_F(CountedJumpsTest, TimesBetweenJumpsAreCheckedAsToldInStatuses) {
  Run run(configure("{dwell_time: [0.5, 2]}"));
  EXPECT_EQ(DwellCheck::kWithin, run.take(jump(0.0)).dwell_check);
  EXPECT_EQ(DwellCheck::kWithin, run.take(jump(0.5)).dwell_check);
  EXPECT_EQ(DwellCheck::kShort, run.take(jump(0.9)).dwell_check);
  EXPECT_EQ(1.0, run.violations_at(2.9));
  EXPECT_EQ(2.0, run.violations_at(2.91));  // overdue, before any jump tells
  EXPECT_EQ(DwellCheck::kLong, run.take(jump(3.0)).dwell_check);
  EXPECT_EQ(2.0, run.violations_at(3.0));
  EXPECT_EQ(DwellCheck::kWithin, run.take(jump(2.0)).dwell_check);
  EXPECT_EQ(1.0, run.violations_at(3.5));
  Run unbounded(configure("{dwell_time: [0.5, .inf]}"));
  unbounded.take(jump(0.0));
  EXPECT_EQ(DwellCheck::kWithin, unbounded.take(jump(40.0)).dwell_check);
  EXPECT_EQ(0.0, unbounded.violations_at(49.0));
  EXPECT_EQ(DwellCheck::kNone, Run(configure()).take(jump(0.0)).dwell_check);
}

TEST_F(CountedJumpsTest, WhatIsKnownOfJumpsOutlastsOtherGains) {
  const Stamp now = kStart + 50 * kSecond;
  const ObserverConfig config = configure("{min_separation: 0.1, dwell_time: [0.5, 2]}");
  ObserverRuntime before(config);
  before.receive(jump(1.0, 3).view(), now);
  ObserverRuntime after(config);
  after.take_over(before, kStart + from_seconds(1.04));
  const auto take = [&](const OwnedEvent& event) { return after.receive(event.view(), now); };
  EXPECT_EQ(EventOutcome::kRepeated, take(jump(1.05, 3)).outcome);
  EXPECT_EQ(EventOutcome::kTooFrequent, take(jump(1.06, 4)).outcome);
  EXPECT_EQ(DwellCheck::kShort, take(jump(1.4, 6)).dwell_check);
  Estimate estimate = after.estimator().make_estimate();
  after.estimator().estimate_at(kStart + from_seconds(1.5), estimate);
  EXPECT_EQ(1.0, after.estimator().law().skipped_jumps(estimate.state.data()));
  EXPECT_EQ(1.0, after.estimator().law().dwell_violations(estimate.state.data()));
}

TEST_F(CountedJumpsTest, AGapIsSeenFromBeforeOtherGains) {
  const Stamp now = kStart + 50 * kSecond;
  ObserverRuntime before(configure());
  before.receive(jump(1.0, 3).view(), now);
  ObserverRuntime after(configure());
  after.take_over(before, kStart + 2 * kSecond);
  const Stamp between = kStart + from_seconds(1.5);
  EXPECT_FALSE(after.estimator().is_before_gap(between));
  after.receive(jump(3.0, 5).view(), now);
  EXPECT_TRUE(after.estimator().is_before_gap(between));
  EXPECT_FALSE(after.estimator().is_before_gap(kStart + from_seconds(0.5)));
  after.receive(jump(2.5, 4).view(), now);
  EXPECT_FALSE(after.estimator().is_before_gap(between));
}

TEST_F(CountedJumpsTest, RestAndGatesOutlastOtherGains) {
  const std::string gated = test::replaced(
      kPlant, "measured: at_jumps",
      "measured: at_jumps, gate: {innovation: 0.5, recovery: {after: 9, action: accept}}");
  const ObserverConfig config =
      parse(gated + "jumps: {rest: {set: [x], margin: 0.1, state: {x: 0}}}");
  const Stamp now = kStart + 50 * kSecond;
  ObserverRuntime before(config);
  OwnedEvent inside = jump(1.3);  // and not at rest
  inside.values = {1.0};
  before.receive(inside.view(), now);
  EXPECT_EQ(EventOutcome::kJumpAlone, before.receive(jump(5.3).view(), now).outcome);
  ObserverRuntime after(config);
  after.take_over(before, kStart + from_seconds(5.4));
  Estimate estimate = after.estimator().make_estimate();
  after.estimator().estimate_at(kStart + 6 * kSecond, estimate);
  EXPECT_TRUE(after.estimator().law().is_at_rest(estimate.state.data()));
  OwnedEvent outlier = jump(6.5);
  outlier.values = {7.0};
  EXPECT_EQ(EventOutcome::kJumpAlone, after.receive(outlier.view(), now).outcome);
}

TEST_F(CountedJumpsTest, WhatIsKnownOfJumpsOutlastsARecoveryByReset) {
  for (const bool is_apart : {false, true}) {  // what is measured is an event of its own
    Run run(parse(test::replaced(
        kPlant, "measured: at_jumps",
        "measured: at_jumps, gate: {innovation: 0.5, recovery: {after: 1, action: reset}}")));
    const auto take = [&](OwnedEvent event, double y) {
      event.values = {y};
      OwnedEvent output{event.stamp, EventKind::kJumpOutput, 0, {y}};
      if (is_apart) event.values.clear();
      const EventReport report = run.take(event);
      return is_apart ? run.take(output) : report;
    };
    take(jump(1.3, 1), 1.0);
    take(jump(1.6, 3), 9.0);
    EXPECT_EQ(Effect::kRestarted, take(jump(2.7, 4), 9.0).effect) << is_apart;
    EXPECT_EQ(1.0, run.lost_at(2.7)) << is_apart;
    EXPECT_EQ(EventOutcome::kRepeated, run.take(jump(2.8, 4)).outcome) << is_apart;
  }
}

/// By the definitions: over all s <= t, of which those just before and at jumps are enough.
TEST_F(CountedJumpsTest, AverageDwellTimesAreThoseOfTheirDefinitions) {
  constexpr double kTau = 0.5;
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> gap(0.0, 1.0);
  int many = 0;
  int few = 0;
  for (int seed = 0; seed < 20; ++seed) {
    const int N0 = 1 + seed % 3;
    const std::string average = "{tau: 0.5, N0: " + std::to_string(N0) + "}";
    Run often(configure("{average_dwell_time: " + average + "}"));
    Run seldom(configure("{reverse_average_dwell_time: " + average + "}"));
    std::vector<double> times = {0.0};
    often.take(jump(0.0));
    seldom.take(jump(0.0));
    for (int k = 1; k < 15; ++k) {
      times.push_back(times.back() + std::round(1000.0 * gap(generator)) / 1000.0 + 0.001);
      const double t = times.back();
      double most = 0.0;
      double least = t / kTau - k;  // from the start
      for (int j = 0; j <= k; ++j) {
        // From just before jump j to just after this one, and from just after it to just before.
        most = std::max(most, k - j + 1 - (t - times[j]) / kTau);
        if (j < k) least = std::max(least, (t - times[j]) / kTau - (k - j - 1));
      }
      const bool is_many = most > N0 + 1e-9;
      const bool is_few = least > N0 + 1e-9;
      EXPECT_EQ(is_many ? DwellCheck::kMany : DwellCheck::kWithin, often.take(jump(t)).dwell_check);
      EXPECT_EQ(is_few ? DwellCheck::kFew : DwellCheck::kWithin, seldom.take(jump(t)).dwell_check);
      many += is_many ? 1 : 0;
      few += is_few ? 1 : 0;
    }
  }
  EXPECT_GT(many, 10);
  EXPECT_GT(few, 10);
}

class BadDwellTimesTest : public ::testing::TestWithParam<Fault> {};

TEST_P(BadDwellTimesTest, AreRefusedWithAMessageThatHelps) {
  const std::string text = std::string(kPlant) +
                           "jumps: {dwell_time: [0.5, 2], average_dwell_time: {tau: 1, N0: 2}, "
                           "reverse_average_dwell_time: {tau: 3, N0: 4}}";
  const std::string found = test::fault(test::replaced(text, GetParam().from, GetParam().to));
  EXPECT_EQ("", test::missing_parts(GetParam(), found)) << found;
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BadDwellTimesTest,
    ::testing::Values(
        Fault{"[0.5, 2]", "[2, 0.5]", {"jumps/dwell_time", "[2, 0.5]"}},
        Fault{"[0.5, 2]", "[0.5]", {"jumps/dwell_time", "two numbers", "list of 1"}},
        Fault{"[0.5, 2]", "[.inf, .inf]", {"jumps/dwell_time", "[.inf, .inf]"}},
        Fault{"[0.5, 2]", "[-1, 2]", {"jumps/dwell_time", "[-1, 2]"}},
        Fault{"{tau: 1, N0: 2}", "{tau: 0, N0: 2}", {"jumps/average_dwell_time/tau"}},
        Fault{"{tau: 1, N0: 2}", "{tau: 1}", {"jumps/average_dwell_time/N0", "missing"}},
        Fault{"{tau: 3, N0: 4}", "{tau: 3, N0: 0}", {"jumps/reverse_average_dwell_time/N0", "0"}},
        Fault{"{tau: 3, N0: 4}", "{tau: 3, N0: 1.5}", {"jumps/reverse_average_dwell_time/N0"}},
        Fault{"{tau: 3, N0: 4}", "{tau: 3, N0: 4, n: 1}", {"n", "unknown key"}}));

}  // namespace
}  // namespace sampled_data_observers
