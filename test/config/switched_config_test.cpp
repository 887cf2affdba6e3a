#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::fault;

const char kModes[] = R"(
observer: SwitchedObserver
plant:
  states: [x1, x2]
  parameters: {k: 0.5}
  modes:
    1: {A: [[0, 1], [-1, 0]]}
    7: {A: [[0, 1], [-4, 0]], jump_map: {A_d: [[1, 0], [0, -1]]}}
sensors:
  c: {C: [[1, 0]], measured: continuous, source: {topic: c}}
  d: {C: [[0, 1]], measured: at_jumps}
sampling: {T1: 0.01, T2: 0.01}
gains:
  L_c:
    1: [[2], [0.5]]
    7: {c: [[3], [-1]]}
  L_d:
    1: [[1], [k*cos(tau)]]
    7: {d: [[0.1], [tau]]}
  projection: {1: [[2, 0.5], [0.5, 1]]}
)";

TEST(SwitchedConfigTest, EachKindOfGainMayBeMissingButNotAll) {
  EXPECT_EQ("no fault", fault(kModes));
  const std::string text = kModes;
  const std::size_t gains = text.find("  L_c:\n");
  const std::size_t at_jumps = text.find("  L_d:\n");
  const std::size_t projection = text.find("  projection:");
  const std::string head = text.substr(0, gains);
  EXPECT_EQ("no fault", fault(head + text.substr(gains, projection - gains)));
  EXPECT_EQ("no fault", fault(head + text.substr(at_jumps)));
  EXPECT_EQ("no fault", fault(head + text.substr(projection)));
  const std::string none = fault(text.substr(0, text.find("gains:")) + "gains: {}\n");
  EXPECT_NE(std::string::npos, none.find("at least one of L_c, L_d, metric and projection"))
      << none;
}

/// A thermostat that is switched off at 1 and on at 0.
const char kThermostat[] = R"(
observer: SwitchedObserver
plant:
  states: [x1]
  modes:
    1: {A: [[0]], b: [1], jump_set: [1 - x1], flow_set: [x1 - 1]}
    2: {A: [[0]], b: [-1], jump_set: [x1], flow_set: [-x1]}
sensors: {c: {C: [[1]], measured: continuous, source: {topic: c}}}
gains: {L_c: {1: [[1]], 2: [[1]]}}
jumps: {gate: {margin: 0.1, recovery: {after: 100}}, missing: {margin: 0.2, action: report}}
history: {duration: 100, max_events: 2000}
)";

TEST(SwitchedConfigTest, EachModeHasItsJumpSetAndItsFlowSet) {
  const ObserverConfig config = test::parse(kThermostat);
  Estimator estimator(config.law, config.options);
  const Stamp start = from_seconds(1000.0);
  estimator.restart(start);
  const auto outcome = [&](double seconds, double mode) {
    Event event{start + from_seconds(seconds), EventKind::kJump, 0, nullptr, 0, 0};
    event.mode = mode;
    return estimator.submit(event, event.stamp).outcome;
  };
  EXPECT_EQ(EventOutcome::kUsed, outcome(0.95, 2.0));
  EXPECT_EQ(EventOutcome::kNotPossible, outcome(1.0, 1.0));  // it is at 0.9, far from 0
  EXPECT_EQ(EventOutcome::kUsed, outcome(1.85, 1.0));
  EXPECT_EQ(EventOutcome::kNotPossible, outcome(2.0, 2.0));  // at 0.2
  Estimate estimate = estimator.make_estimate();
  const auto missing_at = [&](double seconds) {
    EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(start + from_seconds(seconds), estimate));
    return config.law->missing_jumps(estimate.state.data());
  };
  EXPECT_EQ(0.0, missing_at(3.0));  // at 1.15
  EXPECT_EQ(1.0, missing_at(3.1));
}

TEST(SwitchedConfigTest, AllModesHaveSetsOrNone) {
  const std::string common = test::replaced(test::replaced(kThermostat, ", jump_set: [x1]", ""),
                                            "  modes:", "  jump_set: [2]\n  modes:");
  EXPECT_EQ("no fault", fault(common));
  for (const auto& [from, to, found] :
       {std::make_tuple(", jump_set: [x1]", "", "none in mode 2"),
        std::make_tuple(", jump_set: [x1]", ", jump_set: [x1, 1]", "another number in mode 2")}) {
    const std::string message = fault(test::replaced(kThermostat, from, to));
    for (const char* part : {"plant/modes", "jump_set in each mode", found}) {
      EXPECT_NE(std::string::npos, message.find(part)) << message;
    }
  }
}

TEST(SwitchedConfigTest, ADetectorTellsTheMode) {
  const std::string detector = std::string(kModes) + R"(jumps:
  detector:
    source: {topic: t, type: sensor_msgs/Imu, fields: {v: angular_velocity.z}}
    signal: v
    threshold: 0
)";
  EXPECT_EQ("no fault", fault(detector + "    mode: \"v > 3 ? 7 : 1\"\n"));
  const std::string none = fault(detector);
  for (const char* part : {"jumps/detector/mode", "mode that follows", "missing"}) {
    EXPECT_NE(std::string::npos, none.find(part)) << none;
  }
}

using test::Fault;

class BadSwitchedTest : public ::testing::TestWithParam<Fault> {};

TEST_P(BadSwitchedTest, IsRefusedWithAMessageThatHelps) {
  const std::string found = fault(test::replaced(kModes, GetParam().from, GetParam().to));
  EXPECT_EQ("", test::missing_parts(GetParam(), found)) << found;
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BadSwitchedTest,
    ::testing::Values(
        Fault{"    7: {c: [[3], [-1]]}\n", "", {"gains/L_c/7", "missing"}},
        Fault{"7: {c: [[3], [-1]]}", "8: {c: [[3], [-1]]}", {"gains/L_c/7", "missing"}},
        Fault{"    1: [[2], [0.5]]\n",
              "    1: [[2], [0.5]]\n    2: [[2], [0.5]]\n",
              {"gains/L_c/2", "unknown"}},
        Fault{"{c: [[3], [-1]]}", "{d: [[3], [-1]]}", {"gains/L_c/7/c", "missing"}},
        Fault{"{c: [[3], [-1]]}", "{c: [[3]]}", {"gains/L_c/7/c", "2 x 1", "1 x 1"}},
        Fault{"[k*cos(tau)]", "[k*cos(t)]", {"gains/L_d/1", "row 2, column 1", "tau"}},
        Fault{"[k*cos(tau)]", "[x1]", {"gains/L_d/1", "x1"}},
        Fault{"[[1], [k*cos(tau)]]", "[[1, 2], [0, 0]]", {"gains/L_d/1", "2 x 1"}},
        Fault{"{d: [[0.1], [tau]]}", "{c: [[0.1], [tau]]}", {"gains/L_d/7/d", "missing"}},
        Fault{"{1: [[2, 0.5], [0.5, 1]]}", "{1: [[2, 0.5], [0, 1]]}", {"mode 1", "symmetric"}},
        Fault{"{1: [[2, 0.5], [0.5, 1]]}", "{1: [[2, 0.5]]}", {"gains/projection/1", "2 x 2"}},
        Fault{"{1: [[2, 0.5], [0.5, 1]]}", "{7: [[1, 0], [0, 1]]}", {"mode 7", "jump map"}},
        Fault{"{1: [[2, 0.5], [0.5, 1]]}",
              "{3: [[1, 0], [0, 1]]}",
              {"gains/projection/3", "unknown"}},
        Fault{"measured: at_jumps", "source: {topic: d}", {"gains/L_d/1"}}));

}  // namespace
}  // namespace sampled_data_observers
