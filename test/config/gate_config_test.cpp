#include "config/gate_config.h"

#include <gtest/gtest.h>

#include "observer/gated_measurements.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::Fault;
using test::parse;
using test::replaced;

const char kGated[] = R"(
observer: ConstantGainObserver
plant: {states: [p, v], A: [[0, 1], [0, 0]]}
sensors:
  a: {C: [[1, 0]], gate: {innovation: 0.5, recovery: {after: 2, action: accept}}, source: {topic: a}}
  b: {C: [[1, 0], [0, 1]], gate: {innovation: [1, 2], recovery: {after: 3, action: reset}}, source: {topic: b}}
  c: {C: [[1, 0]], source: {topic: c}}
sampling: {T1: 0.1, T2: 1}
gains: {L: {a: [[1], [1]], b: [[1, 0], [0, 1]], c: [[1], [1]]}}
)";

const char kFilter[] = R"(
observer: HybridKalmanFilter
plant: {states: [p, v], A: [[0, 1], [0, 0]], jump_map: {A_d: [[1, 0], [0, -1]]}}
sensors:
  d: {C: [[0, 1]], measured: at_jumps, source: {topic: d}}
  s: {C: [[1, 0]], gate: {mahalanobis: 3, recovery: {after: 2, action: accept}}, source: {topic: s}}
sampling: {T1: 0.1, T2: 1}
gains: {P0: [[1, 0], [0, 1]], R: {d: [[1]], s: [[0.1]]}, Q: [[0, 0], [0, 1]], Q_d: [[0, 0], [0, 0]]}
)";

TEST(GateConfigTest, ReadsBothKinds) {
  for (const char* text : {kGated, kFilter}) {
    EXPECT_NE(nullptr, std::dynamic_pointer_cast<const GatedMeasurements>(parse(text).law));
  }
}

TEST(GateConfigTest, LimitsAndTimesAreThoseConfigured) {
  const ObserverConfig config = parse(kGated);
  Estimator estimator(config.law, config.options);
  const auto submit = [&](double seconds, int sensor, std::vector<double> y) {
    const Stamp stamp = from_seconds(1000.0 + seconds);
    return estimator.submit(
        {stamp, EventKind::kSample, sensor, y.data(), static_cast<Eigen::Index>(y.size()), 0},
        stamp);
  };
  submit(0.0, 0, {0.0});
  submit(0.0, 1, {0.0, 0.0});
  EXPECT_TRUE(submit(0.1, 1, {0.0, 0.0}).used());
  EXPECT_EQ(EventOutcome::kGated, submit(0.2, 0, {0.6}).outcome);
  EXPECT_EQ(EventOutcome::kGated, submit(0.2, 1, {1.1, 0.0}).outcome);
  EXPECT_EQ(EventOutcome::kGated, submit(0.3, 1, {0.0, 2.1}).outcome);
  EXPECT_TRUE(submit(0.3, 2, {0.0}).used());
  EXPECT_EQ(EventOutcome::kGated, submit(2.1, 0, {0.6}).outcome);
  EXPECT_EQ(Effect::kPastGate, submit(2.2, 0, {0.6}).effect);
  EXPECT_EQ(EventOutcome::kGated, submit(3.1, 1, {9.0, 9.0}).outcome);
  EXPECT_EQ(Effect::kRestarted, submit(3.2, 1, {9.0, 9.0}).effect);
}

class BadGateTest : public ::testing::TestWithParam<Fault> {};

TEST_P(BadGateTest, IsRefusedWithAMessageThatHelps) {
  const std::string good =
      std::string(kGated).find(GetParam().from) != std::string::npos ? kGated : kFilter;
  const std::string found = test::fault(replaced(good, GetParam().from, GetParam().to));
  EXPECT_EQ("", test::missing_parts(GetParam(), found)) << found;
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BadGateTest,
    ::testing::Values(
        Fault{"innovation: 0.5", "innovation: 0", {"test.yaml:5", "sensors/a/gate/innovation"}},
        Fault{"innovation: 0.5", "innovation: big", {"a/gate/innovation", "'big'"}},
        Fault{"innovation: 0.5",
              "inovation: 0.5",
              {"a/gate/innovation", "one of", "is 'inovation' a misspelling"}},
        Fault{"innovation: 0.5", "innovation: 1, mahalanobis: 3", {"a/gate/mahalanobis", "both"}},
        Fault{"innovation: 0.5",
              "mahalanobis: 3",
              {"a/gate/mahalanobis", "HybridKalmanFilter", "innovation"}},
        Fault{"innovation: [1, 2]", "innovation: [1]", {"b/gate/innovation", "list of 2"}},
        Fault{"innovation: [1, 2]", "innovation: [1, -2]", {"b/gate/innovation", "positive"}},
        Fault{"recovery: {after: 2, ",
              "recovry: {after: 2, ",
              {"a/gate/recovery", "missing; is 'recovry' a misspelling of it?"}},
        Fault{"after: 2", "after: 0", {"a/gate/recovery/after", "found 0"}},
        Fault{"after: 2, ", "", {"a/gate/recovery/after", "missing"}},
        Fault{"action: reset", "action: retry", {"b/gate/recovery/action", "accept, reset"}},
        Fault{"action: reset", "action: reset, x: 1", {"b/gate/recovery/x", "unknown key"}},
        Fault{"mahalanobis: 3", "mahalanobis: -3", {"s/gate/mahalanobis", "found -3"}}));

TEST(GateConfigTest, SensorsThatMeasureAtJumpsOrContinuouslyMayHaveGatesToo) {
  const char* gate = "gate: {mahalanobis: 3, recovery: {after: 2, action: accept}}, ";
  const ObserverConfig config =
      parse(replaced(kFilter, "measured: at_jumps, ", std::string("measured: at_jumps, ") + gate));
  Estimator estimator(config.law, config.options);
  const auto jump = [&](double seconds, double y) {
    const Stamp stamp = from_seconds(1000.0 + seconds);
    return estimator.submit({stamp, EventKind::kJump, 0, &y, 1, 0}, stamp);
  };
  EXPECT_EQ(EventOutcome::kUsed, jump(0.0, 0.0).outcome);
  EXPECT_EQ(EventOutcome::kJumpAlone, jump(0.1, 50.0).outcome);
  const ObserverConfig continuous = parse(R"(
observer: SynchronizedObserver
plant: {states: [p], A: [[0]]}
sensors:
  c:
    C: [[1]]
    measured: continuous
    gate: {innovation: 0.5, recovery: {after: 2, action: reset}}
    source: {topic: c}
gains: {L_c: [[1]]}
)");
  EXPECT_NE(nullptr, std::dynamic_pointer_cast<const GatedMeasurements>(continuous.law));
}

}  // namespace
}  // namespace sampled_data_observers
