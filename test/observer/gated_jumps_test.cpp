// Gates of outputs that are measured at jumps, and of continuous ones: what is used of them, what a
// jump does without them, and how such a gate recovers.
#include <gtest/gtest.h>

#include <cmath>

#include "observer/gated_measurements.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "support/config_faults.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::parse;
using test::replaced;

constexpr int kHeightAtJumps = 0;  // sensors
constexpr int kContinuousHeight = 1;
constexpr int kSpeedAtJumps = 2;

/// A ball whose height and speed are measured at bounces, and whose height is continuously, too.
const char kGatedBall[] = R"(
observer: SynchronizedObserver
plant:
  states: [h, v]
  A: [[0, 1], [0, 0]]
  b: [0, -9.81]
  jump_map: {A_d: [[1, 0], [0, -0.8]]}
sensors:
  height: {C: [[1, 0]], measured: at_jumps, gate: {innovation: 0.5, recovery: {after: 2, action: accept}}}
  speed: {C: [[0, 1]], measured: at_jumps}
  level: {C: [[1, 0]], measured: continuous, gate: {innovation: 0.2, recovery: {after: 2, action: accept}}, source: {topic: l}}
initial_estimate: {h: 5, v: 0}
gains: {L_c: [[1], [1]], L_d: {height: [[0.5], [0.25]], speed: [[0], [-0.3]]}}
)";

/// What an observer makes of events, one after another.
class ToldOfGates {
 public:
  explicit ToldOfGates(const std::string& text)
      : config_(parse(text)),
        estimator_(config_.law, config_.options),
        estimate_(estimator_.make_estimate()) {
    estimator_.restart(kStart);
  }

  Eigen::Vector2d at(double seconds) {
    EXPECT_EQ(Timeline::Query::kOk, estimator_.estimate_at(stamp_of(seconds), estimate_));
    return estimate_.state.head(2);
  }
  EventReport jump(double seconds, const std::vector<double>& values = {}) {
    return submit(seconds, EventKind::kJump, 0, values);
  }
  /// What was measured at a jump, off by so much from what is expected without the jump.
  EventReport jump_off(double seconds, double height, double speed) {
    const Eigen::Vector2d x = at(seconds);
    return jump(seconds, {x(0) + height, x(1) + speed});
  }
  EventReport jump_output(double seconds, int sensor, double value) {
    return submit(seconds, EventKind::kJumpOutput, sensor, {value});
  }
  EventReport output(double seconds, double value) {
    return submit(seconds, EventKind::kOutput, kContinuousHeight, {value});
  }
  const Estimate& estimate() const { return estimate_; }

 private:
  static Stamp stamp_of(double seconds) { return kStart + from_seconds(seconds); }
  EventReport submit(double seconds, EventKind kind, int sensor,
                     const std::vector<double>& values) {
    const Stamp stamp = stamp_of(seconds);
    return estimator_.submit(
        {stamp, kind, sensor, values.data(), static_cast<Eigen::Index>(values.size()), 0}, stamp);
  }

  ObserverConfig config_;
  Estimator estimator_;
  Estimate estimate_;
};

TEST(GatedJumpsTest, AnOutputOutsideIsLeftOutOfAJumpThatHasEffect) {
  ToldOfGates gated(kGatedBall);
  ToldOfGates in_parts(kGatedBall);
  for (ToldOfGates* each : {&gated, &in_parts}) {
    EXPECT_EQ(EventOutcome::kUsed, each->jump_off(0.5, 0.4, 0.1).outcome);
  }
  const Eigen::Vector2d before = gated.at(1.0);
  const EventReport report = gated.jump_off(1.0, 0.51, 0.2);
  EXPECT_EQ(EventOutcome::kJumpAlone, report.outcome);
  EXPECT_NE(std::string::npos, std::string(describe(report)).find("outside the gate"));
  EXPECT_TRUE(report.used());
  in_parts.jump(1.0);
  in_parts.jump_output(1.0, kSpeedAtJumps, before(1) + 0.2);
  EXPECT_EQ(in_parts.at(1.0), gated.at(1.0));
  EXPECT_NEAR(-0.8 * before(1) - 0.3 * 0.2, gated.at(1.0)(1), 1e-12);
  EXPECT_NEAR(before(0), gated.at(1.0)(0), 1e-12);
  EXPECT_EQ(2u, gated.estimate().counts.jumps);
}

TEST(GatedJumpsTest, OutputsThatAreEventsOfTheirOwnAreComparedWithTheEstimateBeforeTheJump) {
  ToldOfGates gated(kGatedBall);
  gated.jump_off(0.5, 0.0, 0.0);
  const Eigen::Vector2d before = gated.at(1.0);
  EXPECT_EQ(EventOutcome::kUsed, gated.jump(1.0).outcome);
  EXPECT_EQ(EventOutcome::kUsed, gated.jump_output(1.0, kSpeedAtJumps, before(1) + 0.1).outcome);
  const Eigen::Vector2d without = gated.at(1.0);
  EXPECT_EQ(EventOutcome::kGated, gated.jump_output(1.0, kHeightAtJumps, before(0) + 0.6).outcome);
  EXPECT_EQ(without, gated.at(1.0));
  EXPECT_TRUE(gated.jump_output(1.0, kHeightAtJumps, before(0) - 0.4).used());
  EXPECT_NEAR(before(0) - 0.2, gated.at(1.0)(0), 1e-12);
  // Without a jump of its stamp it says nothing, to the gate neither.
  EXPECT_EQ(EventOutcome::kUsed, gated.jump_output(1.1, kHeightAtJumps, 50.0).outcome);
}

TEST(GatedJumpsTest, OutputsOfAJumpThatIsRefusedTellTheGateNothing) {
  ToldOfGates gated(replaced(kGatedBall, "gains:", "jumps: {min_separation: 0.1}\ngains:"));
  gated.jump_off(0.5, 0.0, 0.0);
  EXPECT_EQ(EventOutcome::kTooFrequent, gated.jump_off(0.55, 3.0, 0.0).outcome);
  // Had that one begun the time of rejections, it would be over.
  EXPECT_EQ(EventOutcome::kJumpAlone, gated.jump_off(2.54, 3.0, 0.0).outcome);
  EXPECT_EQ(EventOutcome::kJumpAlone, gated.jump_off(2.75, 3.0, 0.0).outcome);
  EXPECT_EQ(Effect::kPastGate, gated.jump_off(4.54, 3.0, 0.0).effect);
}

TEST(GatedJumpsTest, TheGateIsOpenAtFirstAndTakesAllAgainAfterAWhile) {
  ToldOfGates gated(kGatedBall);
  EXPECT_EQ(EventOutcome::kUsed, gated.jump_off(0.5, 3.0, 0.0).outcome);
  EXPECT_EQ(EventOutcome::kUsed, gated.jump_off(1.0, 0.0, 0.0).outcome);
  EXPECT_EQ(EventOutcome::kJumpAlone, gated.jump_off(1.5, 3.0, 0.0).outcome);
  EXPECT_EQ(EventOutcome::kJumpAlone, gated.jump_off(3.4, 3.0, 0.0).outcome);
  const Eigen::Vector2d before = gated.at(3.5);
  const EventReport report = gated.jump_off(3.5, 3.0, 0.0);
  EXPECT_EQ(Effect::kPastGate, report.effect);
  EXPECT_EQ(EventOutcome::kUsed, report.outcome);
  EXPECT_NEAR(before(0) + 1.5, gated.at(3.5)(0), 1e-12);
}

TEST(GatedJumpsTest, ItMayBeginAnewAndJumpFromThere) {
  const std::string text = replaced(kGatedBall, "0.5, recovery: {after: 2, action: accept}",
                                    "0.5, recovery: {after: 2, action: reset}");
  for (const bool at_once : {true, false}) {
    ToldOfGates gated(text);
    gated.jump_off(0.5, 0.0, 0.0);
    EXPECT_EQ(EventOutcome::kJumpAlone, gated.jump_off(1.0, 3.0, 0.0).outcome);
    if (at_once) {
      EXPECT_EQ(Effect::kRestarted, gated.jump(3.0, {6.0, 1.0}).effect);
    } else {
      EXPECT_EQ(EventOutcome::kUsed, gated.jump(3.0).outcome);
      EXPECT_EQ(EventOutcome::kUsed, gated.jump_output(3.0, kSpeedAtJumps, 1.0).outcome);
      EXPECT_EQ(Effect::kRestarted, gated.jump_output(3.0, kHeightAtJumps, 6.0).effect);
    }
    // From (5, 0), where it is configured to begin.
    EXPECT_NEAR(5.5, gated.at(3.0)(0), 1e-12) << at_once;
    EXPECT_NEAR(0.25 - 0.3, gated.at(3.0)(1), 1e-12) << at_once;
    // The gate is open.
    EXPECT_EQ(EventOutcome::kUsed, gated.jump_off(3.2, 3.0, 0.0).outcome) << at_once;
  }
}

/// Of an estimate that begins anew after a jump was told and before that is released.
TEST(GatedJumpsTest, WhatBeginsAnewIsInTheModeThatWasTold) {
  const ObserverConfig config = parse(R"(
observer: HybridKalmanFilter
plant:
  states: [p, v]
  modes: {1: {A: [[0, 1], [-2, 0]]}, 2: {A: [[0, 1], [0, 0.2]]}, 3: {A: [[0, 1], [0, -0.2]]}}
sensors: {s: {C: [[1, 0]], source: {topic: s}, gate: {innovation: 0.5, recovery: {after: 1, action: reset}}}}
sampling: {T1: 0.1, T2: 1}
jumps: {late: delayed}
gains: {P0: [[1, 0], [0, 2]], R: [[0.1]]}
)");
  const auto stamp_of = [](double seconds) { return kStart + from_seconds(seconds); };
  for (const bool by_gate : {true, false}) {
    Estimator estimator(config.law, config.options);
    const auto sample = [&](double seconds, double y) {
      return estimator.submit({stamp_of(seconds), EventKind::kSample, 0, &y, 1}, stamp_of(seconds));
    };
    sample(0.1, 0.0);
    EXPECT_EQ(EventOutcome::kGated, sample(0.4, 9.0).outcome);
    Event jump{stamp_of(1.3), EventKind::kJump, 0, nullptr, 0, stamp_of(1.6), 3.0};
    EXPECT_TRUE(estimator.submit(jump, stamp_of(1.6)).used());
    if (by_gate) {
      EXPECT_EQ(Effect::kRestarted, sample(1.5, 9.0).effect);
    } else {
      estimator.restart(stamp_of(1.5));
    }
    Estimate estimate = estimator.make_estimate();
    for (const double seconds : {1.5, 1.7}) {
      ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(stamp_of(seconds), estimate));
      EXPECT_EQ(2u, config.law->observer().mode_of(estimate.state.data())) << by_gate;
    }
  }
}

TEST(GatedJumpsTest, AContinuousOutputOutsideLeavesTheOneBeforeHeld) {
  ToldOfGates gated(kGatedBall);
  ToldOfGates without(kGatedBall);
  for (ToldOfGates* each : {&gated, &without}) {
    EXPECT_EQ(EventOutcome::kUsed, each->output(0.1, each->at(0.1)(0) + 0.1).outcome);
  }
  const EventReport report = gated.output(0.15, gated.at(0.15)(0) + 0.3);
  EXPECT_EQ(EventOutcome::kGated, report.outcome);
  EXPECT_NEAR(0.3, report.innovation, 1e-12);
  EXPECT_NEAR(0.0, (without.at(0.2) - gated.at(0.2)).norm(), 1e-12);
  EXPECT_EQ(EventOutcome::kUsed, gated.output(0.2, gated.at(0.2)(0) + 0.15).outcome);
  EXPECT_GT((without.at(0.4) - gated.at(0.4)).norm(), 0.005);
}

TEST(GatedJumpsTest, UncertainStampsWidenTheGateOfAKalmanFilter) {
  const std::string text = R"(
observer: HybridKalmanFilter
plant:
  states: [h, v]
  A: [[0, 1], [0, 0]]
  b: [0, -9.81]
  jump_map: {A_d: [[1, 0], [0, -0.8]]}
sensors:
  height: {C: [[1, 0]], measured: at_jumps, gate: {mahalanobis: 3, recovery: {after: 9, action: accept}}}
initial_estimate: {h: 5, v: 0}
gains: {P0: [[1e-6, 0], [0, 1e-6]], R: [[1e-4]], Q: [[0, 0], [0, 0]], Q_d: [[0, 0], [0, 0]]}
)";
  ToldOfGates certain(text);
  ToldOfGates uncertain(replaced(text, "gains:", "jumps: {stamp_error: 0.02}\ngains:"));
  for (ToldOfGates* each : {&certain, &uncertain}) each->jump(0.5, {each->at(0.5)(0)});
  // At 9.8 m/s, 20 ms are 0.2 m.
  EXPECT_EQ(EventOutcome::kJumpAlone, certain.jump(1.9, {certain.at(1.9)(0) + 0.2}).outcome);
  EXPECT_EQ(EventOutcome::kUsed, uncertain.jump(1.9, {uncertain.at(1.9)(0) + 0.2}).outcome);
  EXPECT_EQ(EventOutcome::kJumpAlone, uncertain.jump(2.5, {uncertain.at(2.5)(0) + 5.0}).outcome);
}

}  // namespace
}  // namespace sampled_data_observers
