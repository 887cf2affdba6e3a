#include "sampled_data_observers/runtime/jump_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace sampled_data_observers {
namespace {

using Finding = JumpDetector::Finding;

JumpDetector::Options options(double threshold, double hysteresis = 0.0) {
  JumpDetector::Options result;
  result.threshold = threshold;
  result.hysteresis = hysteresis;
  return result;
}

/// The jumps found in samples taken every millisecond from 1 ms on.
std::vector<Stamp> jumps(JumpDetector detector, const std::vector<double>& values) {
  std::vector<Stamp> found;
  Stamp stamp = 0;
  for (const double value : values) {
    stamp += 1'000'000;
    if (detector.add(stamp, value) == Finding::kJump) found.push_back(detector.crossing());
  }
  return found;
}

TEST(JumpDetectorTest, InterpolatesTheCrossing) {
  EXPECT_EQ((std::vector<Stamp>{1'750'000}), jumps(JumpDetector(options(3.0)), {0.0, 4.0, 5.0}));
  JumpDetector::Options falling = options(-3.0);
  falling.direction = JumpDetector::Direction::kFalling;
  EXPECT_EQ((std::vector<Stamp>{1'750'000}), jumps(JumpDetector(falling), {0.0, -4.0, -5.0}));
}

TEST(JumpDetectorTest, FindsTheCrossingsOfASine) {
  // sin(t) rises through 1/2 at pi/6 + 2 k pi; sampled at random times up to 2 ms apart.
  JumpDetector detector(options(0.5, 0.1));
  std::mt19937_64 generator(1);
  std::uniform_int_distribution<Duration> step(1, 2'000'000);
  const double period = 2.0 * std::acos(-1.0);
  int found = 0;
  for (Stamp stamp = 1; stamp < 100 * kNanosecondsPerSecond; stamp += step(generator)) {
    if (detector.add(stamp, std::sin(to_seconds(stamp))) != Finding::kJump) continue;
    EXPECT_NEAR(period / 12.0 + found * period, to_seconds(detector.crossing()), 1e-6);
    ++found;
  }
  EXPECT_EQ(16, found);
}

TEST(JumpDetectorTest, ASignalThatBeginsBeyondTheThresholdHasNotCrossedIt) {
  EXPECT_TRUE(jumps(JumpDetector(options(1.0)), {2.0, 3.0, 1.0, 2.0}).empty());
  EXPECT_EQ(1u, jumps(JumpDetector(options(1.0)), {2.0, 0.9, 2.0}).size());
}

TEST(JumpDetectorTest, ChatterWithinTheHysteresisIsOneJump) {
  const std::vector<double> chatter = {0.0, 1.1, 0.9, 1.1, 0.6, 1.1, 0.5, 1.1};
  EXPECT_EQ(4u, jumps(JumpDetector(options(1.0)), chatter).size());
  EXPECT_EQ(2u, jumps(JumpDetector(options(1.0, 0.5)), chatter).size());  // 0.5 has come back
  EXPECT_EQ(1u, jumps(JumpDetector(options(1.0, 0.6)), chatter).size());
}

TEST(JumpDetectorTest, TheSlopeThatCountsIsTheLastOne) {
  // Armed at 0, not yet across at 0.8: the crossing lies between 0.8 and 1.2.
  EXPECT_EQ((std::vector<Stamp>{2'500'000}),
            jumps(JumpDetector(options(1.0, 0.5)), {0.0, 0.8, 1.2}));
}

TEST(JumpDetectorTest, CrossingsWithinTheRefractoryTimeAreNone) {
  JumpDetector::Options slow = options(0.5);
  slow.refractory = 3'000'000;
  // Crossings at 1.5, 3.5, 5.5, 7.5 ms: those at 3.5 and, 2 ms after 5.5, at 7.5 come too soon.
  EXPECT_EQ((std::vector<Stamp>{1'500'000, 5'500'000}),
            jumps(JumpDetector(slow), {0, 1, 0, 1, 0, 1, 0, 1}));
  slow.refractory = 4'000'000;
  EXPECT_EQ((std::vector<Stamp>{1'500'000, 5'500'000}),
            jumps(JumpDetector(slow), {0, 1, 0, 1, 0, 1, 0, 1}));
}

TEST(JumpDetectorTest, SamplesOutOfOrderAndNotFiniteAreAsIfTheyHadNotCome) {
  JumpDetector detector(options(1.0));
  EXPECT_EQ(Finding::kOutOfOrder, detector.add(0, 0.0));
  EXPECT_EQ(Finding::kNothing, detector.add(1000, 0.0));
  EXPECT_EQ(Finding::kOutOfOrder, detector.add(1000, 5.0));
  EXPECT_EQ(Finding::kOutOfOrder, detector.add(500, 5.0));
  EXPECT_EQ(Finding::kNotFinite, detector.add(1500, std::nan("")));
  EXPECT_EQ(Finding::kNotFinite, detector.add(1500, std::numeric_limits<double>::infinity()));
  EXPECT_EQ(Finding::kJump, detector.add(2000, 2.0));
  EXPECT_EQ(1500, detector.crossing());
}

TEST(JumpDetectorTest, AfterARestartItKnowsNoSample) {
  JumpDetector detector(options(1.0));
  detector.add(1000, 0.0);
  detector.restart();
  EXPECT_EQ(Finding::kNothing, detector.add(500, 2.0));
  EXPECT_EQ(Finding::kNothing, detector.add(600, 0.0));
  EXPECT_EQ(Finding::kJump, detector.add(800, 2.0));
  EXPECT_EQ(700, detector.crossing());
}

}  // namespace
}  // namespace sampled_data_observers
