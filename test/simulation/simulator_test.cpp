#include "simulation/simulator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sampled_data_observers/plant/linear_flow.h"
#include "simulation/simulation_support.h"

namespace sampled_data_observers {
namespace {

using test::same;

constexpr Stamp kStart = test::kFirst;

const char kCart[] = R"yaml(
plant:
  states: [p, v]
  inputs: [u]
  A: [[0, 1], [-2, -0.3]]
  B: [[0], [1]]
  integration: {step: 0.001}
sensors:
  position: {C: [[1, 0]], bias: [b], source: {topic: position}}
  speed: {C: [[0, 1]], source: {topic: speed}}
scenario:
  duration: 30
  initial_state: {p: 1, v: -0.5, b: 0.25}
  input: {rate: 20, formulas: {u: "sin(t) - 0.1*v"}}
  truth: {rate: 10}
  sensors:
    position: {schedule: {uniform: [0.05, 0.2]}, latency: [0, 0.3], duplication: 0.1, reordering: 0.1}
    speed: {schedule: {period: 0.02}, noise: {gaussian: 0.3}, loss: 0.2}
)yaml";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(SimulatorTest, TheSameSeedGivesTheSameBitsAndAnotherDoesNot) {
  const std::vector<SimulatedMessage> messages = test::run(kCart);
  EXPECT_GT(messages.size(), 2000u);
  EXPECT_TRUE(same(messages, test::run(kCart)));
  EXPECT_FALSE(
      same(messages, test::run(replaced(kCart, "duration: 30", "duration: 30\n  seed: 2"))));
}

TEST(SimulatorTest, ArrivalsAreInOrderAndNoneIsBeforeItsStamp) {
  const std::vector<SimulatedMessage> messages = test::run(kCart);
  Stamp last = kStart;
  for (const SimulatedMessage& message : messages) {
    EXPECT_GE(message.arrival, last);
    EXPECT_GE(message.arrival, message.stamp);
    last = message.arrival;
  }
  EXPECT_GT(last, kStart);
}

TEST(SimulatorTest, WhatOneStreamDrawsChangesNoOther) {
  Simulator one(test::parse_scenario(kCart));
  Simulator other(test::parse_scenario(replaced(kCart, "gaussian: 0.3}", "uniform: 0.1}")));
  const auto a = test::on_topic(one, test::run(one), "position");
  const auto b = test::on_topic(other, test::run(other), "position");
  EXPECT_GT(a.size(), 200u);
  EXPECT_TRUE(same(a, b));
}

TEST(SimulatorTest, TheTruthIsTheExactFlowUnderTheHeldInput) {
  Simulator simulator(test::parse_scenario(kCart));
  const auto messages = test::run(simulator);
  const auto inputs = test::on_topic(simulator, messages, "input");
  const auto truths = test::on_topic(simulator, messages, "truth");
  ASSERT_EQ(601u, inputs.size());
  ASSERT_EQ(301u, truths.size());
  Eigen::Matrix2d A;
  A << 0.0, 1.0, -2.0, -0.3;
  const LinearFlow flow(A, Eigen::Vector2d(0.0, 1.0));
  Eigen::Vector2d x(1.0, -0.5);
  Eigen::Vector2d scratch;
  std::size_t next_truth = 0;
  for (const SimulatedMessage& input : inputs) {
    const double t = to_seconds(input.stamp - kStart);
    ASSERT_NEAR(std::sin(t) - 0.1 * x(1), input.values[0], 1e-12);
    if (truths[next_truth].stamp == input.stamp) {
      ASSERT_NEAR(x(0), truths[next_truth].values[0], 1e-12);
      ASSERT_NEAR(x(1), truths[next_truth].values[1], 1e-12);
      ASSERT_EQ(0.25, truths[next_truth].values[2]);
      ++next_truth;
    }
    flow.apply(kNanosecondsPerSecond / 20, x.data(), input.values.data(), scratch.data());
  }
  EXPECT_EQ(301u, next_truth);
}

TEST(SimulatorTest, ADisturbedPlantIsIntegrated) {
  // v' = 3 up to t = 0.5 s, then -1; p' = v.
  Simulator simulator(test::parse_scenario(R"yaml(
plant: {states: [p, v], A: [[0, 1], [0, 0]]}
sensors: {s: {C: [[1, 0]], source: {topic: s}}}
scenario:
  duration: 2
  initial_state: {p: 0, v: 0}
  disturbance: {N: [[0], [1]], formulas: ["t < 0.5 ? 3 : -1"]}
  sensors: {s: {schedule: {period: 0.1}}}
)yaml"));
  const auto truths = test::on_topic(simulator, test::run(simulator), "truth");
  ASSERT_EQ(201u, truths.size());
  EXPECT_NEAR(1.5 * 0.16, truths[40].values[0], 1e-12);
  // A step that ends at the switch may see the value after it at its end: 1/6 of 1 ms.
  EXPECT_NEAR(0.0, truths[200].values[1], 1e-3);
  EXPECT_NEAR(0.375 + 1.5 * 1.5 - 0.5 * 1.5 * 1.5, truths[200].values[0], 2e-3);
}

TEST(SimulatorTest, SignalsTellWhatTheirFormulasSayAfterAJump) {
  Simulator simulator(test::parse_scenario(R"yaml(
plant: {states: [p, v], parameters: {scale: 10}, A: [[0, 1], [0, 0]], jump_map: {A_d: [[1, 0], [0, -1]]}}
sensors: {position: {C: [[1, 0]], source: {topic: position}}}
scenario:
  duration: 2
  initial_state: {p: 0, v: 1}
  sensors: {position: {schedule: {period: 1}}}
  signals:
    radar: {formulas: ["scale*v", "t"], schedule: {period: 0.5}, latency: [0.1, 0.1]}
    gyro: {topic: imu/gyro, formulas: [0], schedule: {period: 2}, noise: {uniform: 1}}
  jumps: {schedule: {period: 1}}
)yaml"));
  const std::vector<SimulatedMessage> messages = test::run(simulator);
  const std::vector<SimulatedMessage> radar = test::on_topic(simulator, messages, "radar");
  ASSERT_EQ(5u, radar.size());
  EXPECT_EQ((std::vector<double>{10.0, 0.5}), radar[1].values);
  EXPECT_EQ((std::vector<double>{-10.0, 1.0}), radar[2].values);
  EXPECT_EQ(radar[1].stamp + from_seconds(0.1), radar[1].arrival);
  const std::vector<SimulatedMessage> gyro = test::on_topic(simulator, messages, "imu/gyro");
  ASSERT_EQ(2u, gyro.size());
  EXPECT_NE(0.0, gyro[0].values[0]);
}

TEST(SimulatorTest, NoiseHasItsDistributionAndFormula) {
  Simulator simulator(test::parse_scenario(R"yaml(
plant: {states: [x], A: [[0]]}
sensors:
  f: {C: [[1]], source: {topic: f}}
  g: {C: [[1]], source: {topic: g}}
  u: {C: [[1]], source: {topic: u}}
scenario:
  duration: 100
  initial_state: {x: 5}
  sensors:
    f: {schedule: {period: 0.5}, noise: {formulas: ["0.2*sin(1000*t)"]}}
    g: {schedule: {period: 0.005}, noise: {gaussian: 0.3}}
    u: {schedule: {period: 0.005}, noise: {uniform: 0.2}}
)yaml"));
  const auto messages = test::run(simulator);
  for (const SimulatedMessage& message : test::on_topic(simulator, messages, "f")) {
    const double t = to_seconds(message.stamp - kStart);
    ASSERT_EQ(5.0 + 0.2 * std::sin(1000.0 * t), message.values[0]);
  }
  const auto spread = [&](const char* topic) {
    double sum = 0.0;
    double squares = 0.0;
    const auto found = test::on_topic(simulator, messages, topic);
    for (const SimulatedMessage& message : found) sum += message.values[0] - 5.0;
    for (const SimulatedMessage& message : found) squares += std::pow(message.values[0] - 5.0, 2);
    const auto size = static_cast<double>(found.size());
    EXPECT_NEAR(0.0, sum / size, 0.01) << topic;
    return std::sqrt(squares / size);
  };
  EXPECT_NEAR(0.3, spread("g"), 0.006);
  EXPECT_NEAR(0.2 / std::sqrt(3.0), spread("u"), 0.003);
  for (const SimulatedMessage& message : test::on_topic(simulator, messages, "u")) {
    ASSERT_LE(std::abs(message.values[0] - 5.0), 0.2);
  }
}

}  // namespace
}  // namespace sampled_data_observers
