#include <gtest/gtest.h>

#include <cmath>

#include "simulation/simulation_support.h"
#include "simulation/simulator.h"

namespace sampled_data_observers {
namespace {

using test::kFirst;

constexpr double kGravity = 9.81;

/// A ball that falls from 5 m and keeps 0.8 of its speed at each impact.
std::string ball(const std::string& guard, const std::string& more) {
  return R"yaml(
plant:
  states: [x1, x2]
  A: [[0, 1], [0, 0]]
  b: [0, -9.81]
  jump_map: {A_d: [[-1, 0], [0, -0.8]]}
sensors:
  height: {C: [[1, 0]], source: {topic: height}}
  impact: {C: [[0, 1]], measured: at_jumps}
scenario:
  duration: 20
  initial_state: {x1: 5, x2: 0}
  sensors: {height: {schedule: {uniform: [0.01, 0.3]}}}
  jumps: {when: ")yaml" +
         guard + "\"" + more + "}\n";
}

class BallTest : public ::testing::TestWithParam<const char*> {};

TEST_P(BallTest, JumpsAtTheTimesOfTheClosedFormUpToItsZenoLimit) {
  Simulator simulator(test::parse_scenario(ball(GetParam(), ", min_separation: 1.0e-6")));
  const auto jumps = test::on_topic(simulator, test::run(simulator), "jumps");
  long double time = std::sqrt(10.0L / 9.81L);
  long double speed = std::sqrt(98.1L);
  std::size_t expected = 0;
  for (long double flight = time; flight >= 1e-6L; ++expected) {
    ASSERT_LT(expected, jumps.size());
    EXPECT_NEAR(static_cast<double>(time * 1e9L),
                static_cast<double>(jumps[expected].stamp - kFirst), 2.0)
        << expected;
    ASSERT_EQ(1u, jumps[expected].values.size());
    EXPECT_NEAR(static_cast<double>(-speed), jumps[expected].values[0], 1e-9);
    speed *= 0.8L;
    flight = 2.0L * speed / 9.81L;
    time += flight;
  }
  EXPECT_EQ(expected, jumps.size());
  EXPECT_GT(expected, 60u);
  EXPECT_EQ(Simulator::End::kZeno, simulator.end());
  EXPECT_NE(std::string::npos, simulator.describe_end().find("min_separation"));
  EXPECT_NEAR(static_cast<double>(time), to_seconds(simulator.time()), 3e-9);
}

INSTANTIATE_TEST_SUITE_P(Guards, BallTest, ::testing::Values("-x1", "x2 < 0 ? -x1 : -1"));

TEST(JumpSimulationTest, ABallOnTheGroundRisesBeforeItCanJump) {
  std::string text = ball("-x1", ", min_separation: 0.1");
  text.replace(text.find("{x1: 5, x2: 0}"), 14, "{x1: 0, x2: 3}");
  Simulator simulator(test::parse_scenario(text));
  const auto jumps = test::on_topic(simulator, test::run(simulator), "jumps");
  ASSERT_FALSE(jumps.empty());
  EXPECT_NEAR(2.0 * 3.0 / kGravity, to_seconds(jumps[0].stamp - kFirst), 2e-9);
}

TEST(JumpSimulationTest, AJumpEventIsReleasedWhenItArrives) {
  Simulator simulator(
      test::parse_scenario(ball("-x1", ", min_separation: 0.01, latency: [0.02, 0.04]")));
  const auto jumps = test::on_topic(simulator, test::run(simulator), "jumps");
  ASSERT_GT(jumps.size(), 5u);
  for (const SimulatedMessage& jump : jumps) {
    EXPECT_GE(jump.arrival - jump.stamp, 20000000);
    EXPECT_LE(jump.arrival - jump.stamp, 40000000);
  }
}

TEST(JumpSimulationTest, ABallGoesOnAtRestAfterItsZenoLimit) {
  Simulator simulator(
      test::parse_scenario(ball("-x1", ", min_separation: 0.001, rest: {x1: 0, x2: 0}")));
  const auto messages = test::run(simulator);
  EXPECT_EQ(Simulator::End::kDuration, simulator.end());
  EXPECT_NE(std::string::npos, simulator.describe_end().find("20.000000000 s, at rest since 9.08"));
  // All that came before is as without rest.
  Simulator without(test::parse_scenario(ball("-x1", ", min_separation: 0.001")));
  const auto before = test::run(without);
  EXPECT_EQ(test::on_topic(without, before, "jumps").size(),
            test::on_topic(simulator, messages, "jumps").size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(before[i].stamp, messages[i].stamp);
    ASSERT_EQ(before[i].values, messages[i].values);
  }
  ASSERT_GT(messages.size(), before.size() + 1000u);
  for (std::size_t i = before.size(); i < messages.size(); ++i) {
    for (const double value : messages[i].values) EXPECT_EQ(0.0, value);
  }
}

TEST(JumpSimulationTest, AtRestOnlyTheStatesThatAreNamedStay) {
  // A ball that flies sideways, pushed down at rest; numerically, since it is disturbed.
  for (const char* disturbance :
       {"", "  disturbance: {N: [[0], [1], [0]], formulas: [\"-1\"]}\n"}) {
    Simulator simulator(test::parse_scenario(std::string(R"yaml(
plant:
  states: [p, v, x]
  A: [[0, 1, 0], [0, 0, 0], [0, 0, 0]]
  b: [0, -9.81, 3]
  jump_map: {A_d: [[-1, 0, 0], [0, -0.5, 0], [0, 0, 1]]}
sensors: {s: {C: [[1, 0, 0]], source: {topic: s}}}
scenario:
  duration: 10
  initial_state: {p: 1, v: 0, x: 2}
  sensors: {s: {schedule: {period: 1}}}
  jumps: {when: "-p", min_separation: 0.001, rest: {p: "0.5 + 0*x", v: 0}}
)yaml") + disturbance));
    const auto truth = test::on_topic(simulator, test::run(simulator), "truth");
    ASSERT_EQ(1001u, truth.size());
    EXPECT_EQ(0.5, truth.back().values[0]);
    EXPECT_EQ(0.0, truth.back().values[1]);
    EXPECT_NEAR(32.0, truth.back().values[2], 1e-6);
  }
}

TEST(JumpSimulationTest, ASpikingNeuronFiresEvery31To36Milliseconds) {
  // bernard2022 (44), time in ms.
  Simulator simulator(test::parse_scenario(R"yaml(
plant:
  states: [x1, x2]
  parameters: {I: 10, a: 0.02, b: 0.2, c: -55, d: 4}
  flow: {x1: "0.04*x1^2 + 5*x1 + 140 - x2 + I", x2: "a*(b*x1 - x2)"}
  jump_map: {formulas: {x1: "c", x2: "x2 + d"}}
  integration: {step: 0.01}
sensors:
  membrane: {C: [[1, 0]], measured: at_jumps, source: {topic: membrane}}
scenario:
  duration: 1000
  truth: {rate: 1}
  initial_state: {x1: -55, x2: -6}
  jumps: {when: "x1 - 30"}
)yaml"));
  const auto messages = test::run(simulator);
  const auto jumps = test::on_topic(simulator, messages, "jumps");
  const auto measured = test::on_topic(simulator, messages, "membrane");
  EXPECT_EQ(Simulator::End::kDuration, simulator.end());
  ASSERT_GT(jumps.size(), 25u);
  ASSERT_EQ(jumps.size(), measured.size());
  for (std::size_t i = 3; i < jumps.size(); ++i) {
    const double interval = to_seconds(jumps[i].stamp - jumps[i - 1].stamp);
    EXPECT_GE(interval, 31.0) << i;
    EXPECT_LE(interval, 36.0) << i;
  }
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    EXPECT_TRUE(jumps[i].values.empty());
    EXPECT_EQ(jumps[i].stamp, measured[i].stamp);
    EXPECT_NEAR(30.0, measured[i].values[0], 1e-6);
  }
}

/// Two modes with constant slopes; input, jump and measurements at equal stamps.
const char kSwitched[] = R"yaml(
plant:
  states: [x]
  inputs: [u]
  modes:
    1: {A: [[0]], B: [[1]], jump_map: {A_d: [[0]], b_d: [100]}}
    5: {A: [[0]], B: [[-1]], outputs: {sampled: {C: [[1000]]}}}
sensors:
  at: {C: [[1]], measured: at_jumps}
  fast: {C: [[1]], measured: continuous, source: {topic: fast}}
  sampled: {C: [[1]], source: {topic: sampled}}
scenario:
  duration: 4
  initial_state: {x: 0}
  input: {rate: 1, formulas: {u: "1 + t + 0*x"}}
  sensors:
    fast: {schedule: {period: 1}}
    sampled: {schedule: {period: 1}}
  jumps: {schedule: {period: 2}, modes: [5, 1]}
)yaml";

TEST(JumpSimulationTest, AtOneStampComesTheInputThenTheJumpThenTheMeasurements) {
  Simulator simulator(test::parse_scenario(kSwitched));
  const auto messages = test::run(simulator);
  const auto jumps = test::on_topic(simulator, messages, "jumps");
  ASSERT_EQ(2u, jumps.size());
  EXPECT_EQ(kFirst + 2 * kNanosecondsPerSecond, jumps[0].stamp);
  EXPECT_EQ(5, jumps[0].mode);
  EXPECT_EQ(1, jumps[1].mode);
  // x(2-) = 1 + 2 = 3; the jump from mode 1 sets 100; then x' = -u: x(4) = 100 - 3 - 4.
  EXPECT_NEAR(3.0, jumps[0].values.at(0), 1e-12);
  EXPECT_NEAR(93.0, jumps[1].values.at(0), 1e-12);
  const auto fast = test::on_topic(simulator, messages, "fast");
  const auto sampled = test::on_topic(simulator, messages, "sampled");
  ASSERT_EQ(5u, fast.size());
  EXPECT_NEAR(1.0, fast[1].values[0], 1e-12);
  EXPECT_NEAR(100.0, fast[2].values[0], 1e-12);
  EXPECT_NEAR(100000.0, sampled[2].values[0], 1e-8);  // by the output map of mode 5
  EXPECT_NEAR(93.0, sampled[4].values[0], 1e-12);     // back in mode 1, which has no jump from 5
  std::vector<std::string> topics;
  for (const SimulatedMessage& message : messages) {
    if (message.stamp == jumps[0].stamp) {
      topics.push_back(simulator.channels()[message.channel].topic);
    }
  }
  EXPECT_EQ((std::vector<std::string>{"input", "jumps", "fast", "sampled", "truth"}), topics);
}

TEST(JumpSimulationTest, ASimulationThatOverflowsEndsAndSaysSo) {
  Simulator simulator(test::parse_scenario(R"yaml(
plant: {states: [x], flow: {x: "x^2"}}
sensors: {s: {C: [[1]], source: {topic: s}}}
scenario: {duration: 5, initial_state: {x: 1}, sensors: {s: {schedule: {period: 0.1}}}}
)yaml"));
  for (const SimulatedMessage& message : test::run(simulator)) {
    EXPECT_TRUE(std::isfinite(message.values[0]));
  }
  EXPECT_EQ(Simulator::End::kNotFinite, simulator.end());
  EXPECT_NE(std::string::npos, simulator.describe_end().find("not finite"));
}

}  // namespace
}  // namespace sampled_data_observers
