// Jumps that never happened, jumps told twice, early or late, and jumps that nobody tells of: on a
// ball that bounces, whose height at bounces is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "support/config_faults.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kMillisecond;
using test::kSecond;
using test::kStart;
using test::OwnedEvent;

const char kBall[] = R"(
observer: SynchronizedObserver
plant:
  states: [height, velocity]
  A: [[0, 1], [0, 0]]
  b: [0, -9.81]
  jump_map: {A_d: [[1, 0], [0, -0.8]]}
  jump_set: [height, velocity]
  flow_set: [-height]
sensors: {floor: {C: [[1, 0]], measured: at_jumps}}
sampling: {T1: 0.001, T2: 5}
gains: {L_d: [[1], [-0.5]]}
initial_estimate: {height: 5, velocity: 0}
history: {duration: 100, max_events: 2000}
)";
const char kGate[] = "jumps: {gate: {margin: [0.6, 1], recovery: {after: 2}}}";
const char kPredict[] =
    "jumps: {gate: {margin: [0.6, 1], recovery: {after: 2}}, "
    "missing: {margin: 0.6, action: predict}}";

const char kRest[] =
    "jumps: {gate: {margin: [0.6, 1], recovery: {after: 2}}, "
    "missing: {margin: 0.6, action: predict}, "
    "rest: {set: [height, -height, velocity, -velocity], margin: [0.1, 0.1, 0.3, 0.3], "
    "state: {height: 0, velocity: 0}}}";

/// A ball dropped from 5 m at kStart, and its bounces until 7 s.
class Ball {
 public:
  Ball() {
    double time = std::sqrt(2.0 * 5.0 / kGravity);
    double speed = kGravity * time;
    while (time < 7.0) {
      bounces_.push_back({kStart + from_seconds(time), 0.8 * speed});
      speed *= 0.8;
      time += 2.0 * speed / kGravity;
    }
  }

  std::vector<Stamp> bounces() const {
    std::vector<Stamp> stamps;
    for (const Bounce& bounce : bounces_) stamps.push_back(bounce.stamp);
    return stamps;
  }

  Eigen::Vector2d at(Stamp stamp) const {
    Bounce last{kStart, 0.0};
    double height = 5.0;
    for (const Bounce& bounce : bounces_) {
      if (bounce.stamp > stamp) break;
      last = bounce;
      height = 0.0;
    }
    const double time = to_seconds(stamp - last.stamp);
    return {height + last.speed * time - kGravity * time * time / 2.0,
            last.speed - kGravity * time};
  }

 private:
  static constexpr double kGravity = 9.81;
  struct Bounce {
    Stamp stamp;
    double speed;  ///< after it
  };
  std::vector<Bounce> bounces_;
};

class MistakenJumpsTest : public ::testing::Test {
 protected:
  static ObserverConfig configure(const std::string& jumps) {
    return read_observer_config(
        override_with(read_yaml_text(kBall, "ball.yaml"), read_yaml_text(jumps, "jumps.yaml")),
        no_plant_plugins);
  }

  static OwnedEvent bounce(Stamp stamp, std::uint32_t index = 0) {
    OwnedEvent event{stamp, EventKind::kJump, 0, {0.0}};
    event.index = index;
    return event;
  }

  std::vector<OwnedEvent> bounces() const {
    std::vector<OwnedEvent> events;
    for (const Stamp stamp : ball_.bounces()) events.push_back(bounce(stamp));
    return events;
  }

  /// An estimate that begins with the fall, and takes the events.
  class Run {
   public:
    Run(const ObserverConfig& config, const std::vector<OwnedEvent>& events,
        const Eigen::Vector2d& start = {5.0, 0.0})
        : estimator_(config.law, config.options), estimate_(estimator_.make_estimate()) {
      estimator_.restart(kStart, start);
      for (const OwnedEvent& event : events) {
        const EventReport report = estimator_.submit(event.view(), kStart + 100 * kSecond);
        outcomes.push_back(report.outcome);
        recovered += report.recovers() ? 1 : 0;
      }
    }

    Eigen::Vector2d at(Stamp stamp) {
      EXPECT_EQ(Timeline::Query::kOk, estimator_.estimate_at(stamp, estimate_));
      return estimate_.state.head<2>();
    }
    double missing_at(Stamp stamp) {
      at(stamp);
      return estimate_.law->missing_jumps(estimate_.state.data());
    }
    bool is_at_rest(Stamp stamp) {
      at(stamp);
      return estimate_.law->is_at_rest(estimate_.state.data());
    }
    std::ptrdiff_t count(EventOutcome outcome) const {
      return std::count(outcomes.begin(), outcomes.end(), outcome);
    }

    std::vector<EventOutcome> outcomes;
    int recovered = 0;

   private:
    Estimator estimator_;
    Estimate estimate_;
  };

  /// The largest error of a run from one time on to another, 50 ms around bounces left out.
  double largest_error(Run& run, double from, double to) const {
    const std::vector<Stamp> stamps = ball_.bounces();
    double largest = 0.0;
    for (Stamp stamp = kStart + from_seconds(from); stamp < kStart + from_seconds(to);
         stamp += kSecond / 100) {
      const bool is_near = std::any_of(stamps.begin(), stamps.end(), [&](Stamp bounce) {
        return std::abs(stamp - bounce) < 50 * kMillisecond;
      });
      if (!is_near) largest = std::max(largest, (run.at(stamp) - ball_.at(stamp)).norm());
    }
    return largest;
  }

  Ball ball_;
};

TEST_F(MistakenJumpsTest, AFalseBounceInFlightIsNotPossible) {
  std::vector<OwnedEvent> events = bounces();
  const Stamp in_flight = (events[1].stamp + events[2].stamp) / 2;
  events.push_back(bounce(in_flight));
  Run believed(configure("{}"), events);
  EXPECT_GT(largest_error(believed, 3.3, 3.8), 1.0);
  Run gated(configure(kGate), events);
  EXPECT_EQ(EventOutcome::kNotPossible, gated.outcomes.back());
  EXPECT_EQ(1, gated.count(EventOutcome::kNotPossible));
  EXPECT_LT(largest_error(gated, 0.0, 5.0), 1e-6);
}

TEST_F(MistakenJumpsTest, TheGateRecoversAndSaysSo) {
  const Stamp in_flight = ball_.bounces()[1] - kSecond;
  const std::vector<OwnedEvent> events = {bounce(ball_.bounces()[0]), bounce(in_flight),
                                          bounce(in_flight + 2 * kSecond - 1),
                                          bounce(in_flight + 2 * kSecond)};
  Run run(configure("plant: {jump_set: [height, -height, velocity]}\n"
                    "jumps: {gate: {margin: 0.6, recovery: {after: 2}}}"),
          events);
  EXPECT_EQ(EventOutcome::kNotPossible, run.outcomes[1]);
  EXPECT_EQ(EventOutcome::kNotPossible, run.outcomes[2]);
  EXPECT_EQ(EventOutcome::kUsed, run.outcomes[3]);
  EXPECT_EQ(1, run.recovered);
}

TEST_F(MistakenJumpsTest, ABounceToldTwiceIsTakenOnce) {
  for (const std::uint32_t index : {0u, 3u}) {
    std::vector<OwnedEvent> events = bounces();
    events[2].index = index;
    events.push_back(bounce(events[2].stamp + 2 * kMillisecond, index));
    Run twice(configure("{}"), events);
    Run once(configure(kGate), events);
    EXPECT_EQ(index == 0 ? EventOutcome::kNotPossible : EventOutcome::kRepeated,
              once.outcomes.back());
    EXPECT_LT(largest_error(once, 0.0, 5.0), 1e-6);
    if (index == 0) {
      EXPECT_GT(largest_error(twice, 4.0, 4.8), 1.0);
    } else {
      EXPECT_EQ(EventOutcome::kRepeated, twice.outcomes.back());
    }
  }
}

TEST_F(MistakenJumpsTest, AJumpOfANumberThatWasRefusedMayComeAgain) {
  std::vector<OwnedEvent> events = bounces();
  events[1].index = 2;
  events.push_back(bounce(events[1].stamp - 200 * kMillisecond, 2));  // too early
  Run run(configure(kGate), events);
  EXPECT_EQ(EventOutcome::kNotPossible, run.outcomes.back());
  EXPECT_LT(largest_error(run, 0.0, 5.0), 1e-6);
}

TEST_F(MistakenJumpsTest, NumbersOrderTheJumpsOfOneStamp) {
  for (const bool turned : {false, true}) {
    std::vector<OwnedEvent> events = {bounce(kStart + kSecond, 2), bounce(kStart + kSecond, 1)};
    events[0].values = {0.5};
    events[1].values = {0.25};
    if (turned) std::swap(events[0], events[1]);
    EXPECT_LT(compare(events[turned ? 0 : 1].view(), events[turned ? 1 : 0].view()), 0);
  }
}

TEST_F(MistakenJumpsTest, AMissedBounceIsMadeUpWhenItWasDue) {
  for (const std::size_t missed : {std::size_t{0}, std::size_t{2}, std::size_t{4}}) {
    std::vector<OwnedEvent> events = bounces();
    const Stamp due = events[missed].stamp;
    events.erase(events.begin() + static_cast<std::ptrdiff_t>(missed));
    Run lost(configure("{}"), events);
    EXPECT_GT(largest_error(lost, to_seconds(due - kStart) + 0.1, 6.0), 1.0);
    Run predicted(configure(kPredict), events);
    // It is noticed 0.6 m below the floor.
    EXPECT_EQ(0.0, predicted.missing_at(due + kMillisecond));
    EXPECT_EQ(1.0, predicted.missing_at(due + kSecond / 4));
    EXPECT_EQ(0, predicted.count(EventOutcome::kNotPossible));
    EXPECT_LT(largest_error(predicted, to_seconds(due - kStart) + 0.25, 6.9), 1e-5) << missed;
  }
}

TEST_F(MistakenJumpsTest, AnEstimateThatIsWrongMissesNoJump) {
  // High up at the first bounce, and then far too slow: it falls through the floor.
  const Eigen::Vector2d wrong(0.1, 8.0);
  Run plain(configure("{}"), bounces(), wrong);
  Run predicted(configure("jumps: {missing: {margin: 0.6, action: predict}}"), bounces(), wrong);
  double lowest = 0.0;
  for (Stamp stamp = kStart; stamp < kStart + 7 * kSecond; stamp += kSecond / 50) {
    lowest = std::min(lowest, plain.at(stamp)(0));
    ASSERT_NEAR(0.0, (predicted.at(stamp) - plain.at(stamp)).norm(), 1e-6)
        << to_seconds(stamp - kStart);
  }
  EXPECT_LT(lowest, -1.0);
  EXPECT_EQ(0.0, predicted.missing_at(kStart + 7 * kSecond));
}

TEST_F(MistakenJumpsTest, AnEstimateThatWasRightAgainMissesJumps) {
  std::vector<OwnedEvent> events = bounces();
  const Stamp due = events.back().stamp;
  events.pop_back();
  Run run(configure("jumps: {missing: {margin: 0.6, action: predict}}"), events,
          Eigen::Vector2d(6.0, 0.5));
  EXPECT_EQ(0.0, run.missing_at(due));
  EXPECT_EQ(1.0, run.missing_at(due + kSecond / 2));
}

TEST_F(MistakenJumpsTest, WhatIsMissingIsReportedOnce) {
  std::vector<OwnedEvent> events = bounces();
  const Stamp due = events[1].stamp;
  events.resize(1);
  Run run(configure("jumps: {missing: {margin: 0.6, action: report}}"), events);
  EXPECT_EQ(0.0, run.missing_at(due));
  EXPECT_EQ(1.0, run.missing_at(due + kSecond));
  Run plain(configure("{}"), events);
  EXPECT_NEAR(0.0, (run.at(due + kSecond) - plain.at(due + kSecond)).norm(), 1e-6);
}

TEST_F(MistakenJumpsTest, JitterCostsNoMoreThanItsTime) {
  std::mt19937_64 generator(1);
  for (const int milliseconds : {1, 5, 20}) {
    std::vector<OwnedEvent> events = bounces();
    std::uniform_int_distribution<Duration> jitter(-milliseconds * kMillisecond,
                                                   milliseconds * kMillisecond);
    for (OwnedEvent& event : events) event.stamp += jitter(generator);
    Run run(configure(kPredict), events);
    EXPECT_EQ(0, run.count(EventOutcome::kNotPossible)) << milliseconds;
    EXPECT_EQ(0.0, run.missing_at(kStart + 5 * kSecond)) << milliseconds;
    // A bounce at 9.9 m/s that is off by 1 ms puts the velocity off by (1 + 0.8) g times that, and
    // the height by (1 + 0.8) 9.9 m/s times that.
    EXPECT_LT(largest_error(run, 0.0, 5.0), 0.05 * milliseconds) << milliseconds;
  }
}

TEST_F(MistakenJumpsTest, BehindTheLastBounceTheBallRests) {
  Run run(configure(kPredict), bounces());
  // All bounces until the end, 9.08 s after the fall began, come to nobody's knowledge.
  EXPECT_GT(run.missing_at(kStart + 9 * kSecond + kSecond / 2), 3.0);
  EXPECT_LT(std::abs(run.at(kStart + 9 * kSecond + kSecond / 2)(0)), 0.65);
}

TEST_F(MistakenJumpsTest, WithAStateAtRestItLiesOnTheFloorUntilItIsFoundElsewhere) {
  std::vector<OwnedEvent> events = bounces();
  const std::size_t told = 5;
  const Stamp first_untold = events[told].stamp;
  events.resize(told);
  const auto after = [](double seconds) { return kStart + from_seconds(seconds); };
  Run run(configure(kRest), events);
  // It bounces on with the ball, once it is noticed that a bounce was not told.
  EXPECT_LT(largest_error(run, to_seconds(first_untold - kStart) + 0.4, 6.9), 1e-5);
  // After a bounce at less than 0.3 m/s, some 0.3 s before the last one at 9.08 s.
  EXPECT_FALSE(run.is_at_rest(after(8.6)));
  for (const double time : {9.1, 12.0, 90.0}) {
    EXPECT_TRUE(run.is_at_rest(after(time))) << time;
    EXPECT_EQ(Eigen::Vector2d::Zero(), run.at(after(time))) << time;
  }
  const double missing = run.missing_at(after(90.0));
  EXPECT_GT(missing, 6.0);
  EXPECT_LT(missing, 16.0);
  // Bounces at the floor say that it lies there; one 2 m above does not.
  events.push_back(bounce(after(10.0)));
  Run lying(configure(kRest), events);
  EXPECT_EQ(EventOutcome::kUsed, lying.outcomes.back());
  EXPECT_EQ(Eigen::Vector2d::Zero(), lying.at(after(12.0)));
  events.push_back(bounce(after(12.0)));
  events.back().values = {2.0};
  Run lifted(configure(kRest), events);
  EXPECT_FALSE(lifted.is_at_rest(after(12.0)));
  EXPECT_NEAR(2.0, lifted.at(after(12.0))(0), 1e-9);
  EXPECT_LT(lifted.at(after(12.2))(0), 1.7);
}

TEST_F(MistakenJumpsTest, AJumpThatIsToldLeadsToRestAsWell) {
  const std::string rest =
      "jumps: {rest: {set: [height, -height, velocity, -velocity], margin: 0.3, "
      "state: {velocity: 0}}}";
  std::vector<OwnedEvent> events = bounces();
  Run falling(configure(rest), events, Eigen::Vector2d(5.0, 0.0));
  EXPECT_FALSE(falling.is_at_rest(kStart + 6 * kSecond));
  // A state that is not named stays as it was.
  events = {bounce(kStart + kSecond / 10)};
  events.front().values = {0.25};
  Run run(configure(rest), events, Eigen::Vector2d(0.3, 0.7));
  EXPECT_TRUE(run.is_at_rest(kStart + kSecond / 10));
  EXPECT_NEAR(0.25, run.at(kStart + kSecond)(0), 1e-9);
  EXPECT_EQ(0.0, run.at(kStart + kSecond)(1));
}

TEST_F(MistakenJumpsTest, WhatIsMeasuredAtAJumpLeadsToRestWhereverItComesFrom) {
  const ObserverConfig config = configure(
      "jumps: {rest: {set: [height, -height, velocity, -velocity], margin: 0.3, "
      "state: {velocity: 0}}}");
  const Eigen::Vector2d start(0.45, 0.8);
  const Stamp stamp = kStart + kSecond / 10;
  const OwnedEvent alone{stamp, EventKind::kJump, 0, {}};
  const OwnedEvent output{stamp, EventKind::kJumpOutput, 0, {0.25}};
  OwnedEvent both = alone;
  both.values = output.values;
  Run without(config, {alone}, start);
  EXPECT_FALSE(without.is_at_rest(stamp));
  Run together(config, {both}, start);
  EXPECT_TRUE(together.is_at_rest(stamp));
  for (const std::vector<OwnedEvent>& events :
       {std::vector<OwnedEvent>{alone, output}, {output, alone}}) {
    Run apart(config, events, start);
    EXPECT_TRUE(apart.is_at_rest(stamp));
    EXPECT_EQ(together.at(kStart + kSecond), apart.at(kStart + kSecond));
  }
}

TEST_F(MistakenJumpsTest, FaultsOfRestAreRefused) {
  const auto fault = [](const std::string& rest, const std::string& change = "{}") {
    return test::fault_of([&] {
      read_observer_config(
          override_with(override_with(read_yaml_text(kBall, "ball.yaml"),
                                      read_yaml_text("jumps: {rest: " + rest + "}", "jumps.yaml")),
                        read_yaml_text(change, "change.yaml")),
          no_plant_plugins);
    });
  };
  const auto names = [](const std::string& message, const char* part) {
    return message.find(part) != std::string::npos;
  };
  EXPECT_EQ("no fault", fault("{set: [height], margin: 0, state: {height: 0}}"));
  EXPECT_PRED2(names, fault("{set: [height], margin: [0, 1], state: {}}"), "jumps/rest/margin");
  EXPECT_PRED2(names, fault("{set: [high], margin: 0, state: {}}"), "jumps/rest/set");
  EXPECT_PRED2(names, fault("{margin: 0, state: {}}"), "jumps/rest/set");
  EXPECT_PRED2(names, fault("{set: [height], margin: 0}"), "jumps/rest/state");
  EXPECT_PRED2(names, fault("{set: [height], margin: 0, state: {high: 0}}"), "high");
  EXPECT_PRED2(names, fault("{set: [height], margin: 0, state: {height: x}}"),
               "jumps/rest/state/height");
  EXPECT_PRED2(names,
               fault("{set: [height], margin: 0, state: {height: 0}}",
                     "{sensors: {eye: {C: [[1, 0]], measured: continuous, source: {topic: eye}}}, "
                     "gains: {L_c: [[1], [1]]}}"),
               "jumps/rest");
}

TEST_F(MistakenJumpsTest, WhatIsMadeUpNeedsNoLeaveOfTheGate) {
  const ObserverConfig config = configure(
      "plant: {jump_set: [height, -height, velocity]}\n"
      "jumps: {gate: {margin: 0.1, recovery: {after: 2}}, missing: {margin: 0.3, action: "
      "predict}}");
  // Further below the floor than where the gate believes that a ball bounces.
  const Stamp first = ball_.bounces().front();
  std::vector<OwnedEvent> events = {bounce(first), bounce(ball_.bounces()[1])};
  Run run(config, events);
  for (Stamp stamp = first + 8 * kSecond; stamp < first + 30 * kSecond; stamp += kSecond / 10) {
    ASSERT_NEAR(0.0, run.at(stamp)(0), 0.35) << to_seconds(stamp - first);
  }
}

TEST_F(MistakenJumpsTest, WhatIsMadeUpLeavesTheLimitsToJumpsThatAreTold) {
  // At rest a jump is made up each millisecond.
  const ObserverConfig config =
      configure("jumps: {max_per_second: 2, missing: {margin: 0.3, action: predict}}");
  std::vector<OwnedEvent> events = bounces();
  events.resize(1);
  events.push_back(bounce(kStart + 30 * kSecond));
  Run run(config, events);
  EXPECT_GT(run.missing_at(kStart + 29 * kSecond), 100.0);
  EXPECT_NEAR(0.0, run.at(kStart + 29 * kSecond)(0), 0.35);
  EXPECT_EQ(EventOutcome::kUsed, run.outcomes.back());
}

TEST_F(MistakenJumpsTest, AJumpWithoutAFiniteCorrectionIsAJumpAllTheSame) {
  const ObserverConfig config = configure("gains: {L_d: [[1.0e60], [0]]}");
  OwnedEvent measured = bounce(ball_.bounces().front());
  OwnedEvent bare = measured;
  measured.values = {1e99};
  bare.values.clear();
  Run with(config, {measured});
  Run without(config, {bare});
  EXPECT_EQ(EventOutcome::kJumpAlone, with.outcomes.back());
  EXPECT_EQ(EventOutcome::kUsed, without.outcomes.back());
  for (const Duration after : {Duration{0}, kSecond / 3}) {
    EXPECT_EQ(without.at(bare.stamp + after), with.at(bare.stamp + after));
  }
  EXPECT_GT(with.at(bare.stamp)(1), 7.0);
}

TEST_F(MistakenJumpsTest, EstimatesDoNotDependOnTheOrderOfArrival) {
  std::mt19937_64 generator(2);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<OwnedEvent> events = bounces();
    std::uniform_int_distribution<std::size_t> choice(0, events.size() - 1);
    std::uniform_int_distribution<Stamp> any(kStart, kStart + 7 * kSecond);
    events.erase(events.begin() + static_cast<std::ptrdiff_t>(choice(generator)));
    events.push_back(bounce(any(generator), 5));
    events.push_back(bounce(any(generator), 5));
    const ObserverConfig config = configure(trial % 2 == 0 ? kPredict : kRest);
    Run reference(config, events);
    std::shuffle(events.begin(), events.end(), generator);
    Run shuffled(config, events);
    for (int i = 0; i < 20; ++i) {
      const Stamp stamp = any(generator);
      ASSERT_EQ(reference.at(stamp), shuffled.at(stamp)) << trial;
      ASSERT_EQ(reference.missing_at(stamp), shuffled.missing_at(stamp)) << trial;
    }
  }
}

}  // namespace
}  // namespace sampled_data_observers
