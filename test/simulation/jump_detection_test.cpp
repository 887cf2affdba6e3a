// Jumps that are told of at the wrong time, not at all, twice, or that never happened.
#include "simulation/jump_detection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

#include "simulation/simulation_support.h"
#include "simulation/simulator.h"

namespace sampled_data_observers {
namespace {

using test::kFirst;
using test::same;

constexpr Duration kMillisecond = 1'000'000;

/// It jumps every 0.1 s; x is the time since the start, and impact has a topic of its own.
std::string scenario(const std::string& faults) {
  return R"yaml(
plant:
  states: [x]
  A: [[0]]
  b: [1]
  jump_map: {A_d: [[1]]}
sensors:
  height: {C: [[1]], measured: at_jumps}
  impact: {C: [[1]], measured: at_jumps, source: {topic: impact}}
  clock: {C: [[1]], source: {topic: clock}}
scenario:
  duration: 200
  truth: {rate: 1}
  initial_state: {x: 0}
  sensors:
    height: {noise: {gaussian: 0.001}}
    impact: {noise: {gaussian: 0.001}}
    clock: {schedule: {period: 0.5}, noise: {gaussian: 0.001}}
  jumps: {schedule: {period: 0.1})yaml" +
         faults + "}\n";
}

struct SimulatedRun {
  explicit SimulatedRun(const std::string& faults)
      : simulator(test::parse_scenario(scenario(faults))), messages(test::run(simulator)) {}

  std::vector<SimulatedMessage> on(const std::string& topic) const {
    return test::on_topic(simulator, messages, topic);
  }

  Simulator simulator;
  std::vector<SimulatedMessage> messages;
};

/// Of the jump at 0.1 s, 0.2 s ... that is nearest.
Duration error_of(const SimulatedMessage& jump) {
  const Duration period = 100 * kMillisecond;
  const Duration since = jump.stamp - kFirst;
  return since - (since + period / 2) / period * period;
}

TEST(JumpDetectionTest, StampErrorsAreUniformAndMoveNoArrivalBeforeJumpAndStamp) {
  const auto told_exactly = SimulatedRun("").on("jumps");
  const SimulatedRun run(", stamp_error: 0.02");
  const auto jumps = run.on("jumps");
  const auto impacts = run.on("impact");
  ASSERT_EQ(2000u, jumps.size());
  ASSERT_EQ(2000u, impacts.size());
  Duration least = 0;
  Duration greatest = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    const Duration error = error_of(jumps[i]);
    least = std::min(least, error);
    greatest = std::max(greatest, error);
    sum += to_seconds(error);
    EXPECT_EQ(std::max(jumps[i].stamp, jumps[i].stamp - error), jumps[i].arrival);
    EXPECT_EQ(jumps[i].stamp, impacts[i].stamp);
    EXPECT_EQ(told_exactly[i].values, jumps[i].values);
  }
  EXPECT_GE(least, -20 * kMillisecond);
  EXPECT_LT(least, -19 * kMillisecond);
  EXPECT_LE(greatest, 20 * kMillisecond);
  EXPECT_GT(greatest, 19 * kMillisecond);
  EXPECT_NEAR(0.0, sum / 2000.0, 5.0 * 0.04 / std::sqrt(12.0 * 2000.0));
}

TEST(JumpDetectionTest, MissedJumpsAndWhatIsMeasuredAtThemAreNotThere) {
  const SimulatedRun run(", missed: 0.2");
  const auto jumps = run.on("jumps");
  EXPECT_NEAR(0.8, static_cast<double>(jumps.size()) / 2000.0, 0.045);
  const auto impacts = run.on("impact");
  ASSERT_EQ(jumps.size(), impacts.size());
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    EXPECT_EQ(0, error_of(jumps[i]));
    EXPECT_EQ(jumps[i].stamp, impacts[i].stamp);
  }
  EXPECT_EQ(2000u, run.simulator.jumps());
}

TEST(JumpDetectionTest, TheEndSaysWhatWasToldWrongly) {
  EXPECT_EQ("2000 jumps", SimulatedRun("").simulator.describe_jumps());
  const SimulatedRun run(", missed: 0.2, duplicate: 0.25, stamp_error: 0.005, false_rate: 2");
  // What was sent is all that was told: twice where it is doubled.
  const std::string text = run.simulator.describe_jumps();
  int missed = 0;
  int doubled = 0;
  int off = 0;
  int invented = 0;
  ASSERT_EQ(4,
            std::sscanf(text.c_str(),
                        "2000 jumps, of which %d were not told of, %d twice, %d with stamps that "
                        "are off; %d told of that never happened",
                        &missed, &doubled, &off, &invented))
      << text;
  EXPECT_EQ(2000 - missed + doubled + invented, static_cast<int>(run.on("jumps").size()));
  EXPECT_EQ(2000 - missed, off);  // one of 10 million is not, by chance
  EXPECT_NEAR(400, missed, 100);
  EXPECT_NEAR(400, doubled, 100);
  EXPECT_NEAR(400, invented, 100);
}

TEST(JumpDetectionTest, DuplicatesHaveAStampOfTheirOwn) {
  const SimulatedRun run(", duplicate: 0.25, stamp_error: 0.005");
  const auto jumps = run.on("jumps");
  EXPECT_NEAR(1.25, static_cast<double>(jumps.size()) / 2000.0, 0.05);
  std::set<Stamp> stamps;
  int twice = 0;
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    stamps.insert(jumps[i].stamp);
    if (i == 0 || jumps[i].stamp - jumps[i - 1].stamp > 50 * kMillisecond) continue;
    ++twice;
    EXPECT_EQ(jumps[i - 1].values, jumps[i].values);
    EXPECT_LE(jumps[i - 1].arrival, jumps[i].arrival);
  }
  EXPECT_EQ(jumps.size(), stamps.size());
  EXPECT_EQ(jumps.size(), 2000u + static_cast<std::size_t>(twice));
}

TEST(JumpDetectionTest, FalseJumpsComeAtTheirRateAndMeasureWhatIsThere) {
  const SimulatedRun run(", false_rate: 5");
  const auto jumps = run.on("jumps");
  const auto impacts = run.on("impact");
  ASSERT_EQ(jumps.size(), impacts.size());
  // Of a Poisson process, 1000 in 200 s.
  EXPECT_NEAR(3000.0, static_cast<double>(jumps.size()), 5.0 * std::sqrt(1000.0));
  double squares = 0.0;
  double sum = 0.0;
  Stamp last = kFirst;
  int alarms = 0;
  for (const SimulatedMessage& jump : jumps) {
    EXPECT_NEAR(to_seconds(jump.stamp - kFirst), jump.values[0], 0.01);
    if (error_of(jump) == 0) continue;
    ++alarms;
    const double interval = to_seconds(jump.stamp - last);
    last = jump.stamp;
    sum += interval;
    squares += interval * interval;
  }
  // The variance of exponential intervals is the square of their mean.
  const double mean = sum / alarms;
  EXPECT_NEAR(2.0, squares / alarms / (mean * mean), 0.6);
}

TEST(JumpDetectionTest, NothingElseChangesAndWithoutFaultsNothingDoes) {
  const SimulatedRun exact("");
  const SimulatedRun none(", stamp_error: 0, missed: 0, duplicate: 0, false_rate: 0");
  EXPECT_TRUE(same(exact.messages, none.messages));
  const std::string faults = ", stamp_error: 0.01, missed: 0.3, duplicate: 0.3";
  const SimulatedRun faulty(faults);
  EXPECT_TRUE(same(faulty.messages, SimulatedRun(faults).messages));
  for (const char* topic : {"clock", "truth"}) {
    EXPECT_TRUE(same(exact.on(topic), faulty.on(topic))) << topic;
  }
  std::set<std::vector<double>> measured;
  for (const SimulatedMessage& jump : exact.on("jumps")) measured.insert(jump.values);
  for (const SimulatedMessage& jump : faulty.on("jumps")) {
    EXPECT_EQ(1u, measured.count(jump.values));
  }
}

TEST(JumpDetectionTest, FalseJumpsDrawNoNoiseOfTrueOnes) {
  const auto exact = SimulatedRun("").on("clock");
  const auto with_false = SimulatedRun(", false_rate: 3").on("clock");
  ASSERT_EQ(exact.size(), with_false.size());
  // Up to rounding: the state is also needed at the false jumps.
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(exact[i].values[0], with_false[i].values[0], 1e-9);
  }
  const auto jumps = SimulatedRun("").on("jumps");
  std::size_t next = 0;
  for (const SimulatedMessage& jump : SimulatedRun(", false_rate: 3").on("jumps")) {
    if (error_of(jump) != 0) continue;
    EXPECT_NEAR(jumps.at(next++).values[0], jump.values[0], 1e-9);
  }
  EXPECT_EQ(jumps.size(), next);
}

TEST(JumpDetectionTest, AFalseJumpOfASwitchedPlantIsIntoAnotherMode) {
  Simulator simulator(test::parse_scenario(R"yaml(
plant:
  states: [x]
  modes: {1: {A: [[0]]}, 5: {A: [[0]]}, 7: {A: [[0]]}}
sensors: {s: {C: [[1]], source: {topic: s}}}
scenario:
  duration: 100
  initial_state: {x: 0}
  initial_mode: 5
  sensors: {s: {schedule: {period: 1}}}
  jumps: {schedule: {period: 1000}, modes: [1], false_rate: 10}
)yaml"));
  const auto jumps = test::on_topic(simulator, test::run(simulator), "jumps");
  int into_first = 0;
  for (const SimulatedMessage& jump : jumps) {
    ASSERT_TRUE(jump.mode == 1 || jump.mode == 7);
    into_first += jump.mode == 1 ? 1 : 0;
  }
  EXPECT_NEAR(0.5, into_first / static_cast<double>(jumps.size()), 0.1);
  EXPECT_EQ(0u, simulator.jumps());
}

}  // namespace
}  // namespace sampled_data_observers
