// Jumps that show as steps or deviations in noise, by a guard, and with enough energy between.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "sampled_data_observers/plant/expression_map.h"
#include "sampled_data_observers/runtime/jump_detector.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

using Direction = JumpDetector::Direction;
using Finding = JumpDetector::Finding;
using Kind = JumpDetector::Kind;
using Options = JumpDetector::Options;

constexpr Duration kPeriod = 1'000'000;

Options steps(double threshold, std::size_t window, Direction direction = Direction::kRising) {
  Options options;
  options.kind = Kind::kStep;
  options.threshold = threshold;
  options.window = window;
  options.direction = direction;
  return options;
}

/// The value of a signal and its energy, by the number of the sample.
using Signal = std::function<double(int)>;

double no_energy(int) { return 0.0; }

/// The jumps found in samples taken every millisecond from 1 ms on, in milliseconds.
std::vector<double> jumps(JumpDetector& detector, int samples, const Signal& signal,
                          const Signal& energy = no_energy) {
  std::vector<double> found;
  for (int i = 1; i <= samples; ++i) {
    if (detector.add(i * kPeriod, signal(i), energy(i)) != Finding::kJump) continue;
    found.push_back(static_cast<double>(detector.crossing()) / kPeriod);
  }
  return found;
}

std::vector<double> jumps(const Options& options, int samples, const Signal& signal,
                          const Signal& energy = no_energy) {
  JumpDetector detector(options);
  return jumps(detector, samples, signal, energy);
}

/// Up by 1 between samples 20 and 21, down by 1 between 40 and 41.
double pulse(int i) { return i > 20 && i <= 40 ? 1.0 : 0.0; }

TEST(StepDetectorTest, AStepLiesBetweenTheSamplesThatItParts) {
  for (const std::size_t window : {1u, 2u, 5u, 10u}) {
    EXPECT_EQ(std::vector<double>{20.5}, jumps(steps(0.5, window), 100, pulse)) << window;
    EXPECT_EQ(std::vector<double>{40.5},
              jumps(steps(0.5, window, Direction::kFalling), 100, pulse));
    EXPECT_EQ((std::vector<double>{20.5, 40.5}),
              jumps(steps(0.5, window, Direction::kEither), 100, pulse));
    EXPECT_EQ((std::vector<double>{20.5}), jumps(steps(1.0, window), 100, pulse));
    EXPECT_TRUE(jumps(steps(1.01, window, Direction::kEither), 100, pulse).empty());
  }
}

TEST(StepDetectorTest, ASlopeIsNoStep) {
  // 0.01 a sample: means of 5 samples differ by 0.05.
  const auto ramp = [](int i) { return 0.01 * i + pulse(i); };
  EXPECT_EQ(std::vector<double>{20.5}, jumps(steps(0.1, 5), 100, ramp));
}

TEST(StepDetectorTest, TellsWithinTwoWindowsAndWhichSampleWasTheLastBefore) {
  constexpr std::size_t kWindow = 4;
  // What comes back at once, and what stays.
  for (const double threshold : {0.2, 0.99}) {
    JumpDetector detector(steps(threshold, kWindow));
    int told = 0;
    for (int i = 1; i <= 40; ++i) {
      if (detector.add(i * kPeriod, pulse(i)) == Finding::kJump) told = i;
      if (told == i) {
        EXPECT_EQ(20u, i - detector.samples_ago());
        EXPECT_LE(detector.samples_ago(), detector.most_samples_ago());
      }
    }
    EXPECT_GT(told, 20);
    EXPECT_LE(told, 20 + 2 * static_cast<int>(kWindow));
  }
}

TEST(StepDetectorTest, TellsWithinTwoWindowsOfAStepThatASlopeFollows) {
  JumpDetector detector(steps(0.5, 4));
  // Its change stays large enough, so that a second step is a part of the first one.
  const auto slope = [](int i) { return i > 20 ? (i > 60 ? 100.0 : 10.0) + 0.5 * i : 0.0; };
  EXPECT_TRUE(jumps(detector, 27, slope).empty());
  EXPECT_EQ(Finding::kJump, detector.add(28 * kPeriod, slope(28)));
  EXPECT_EQ(20'500'000, detector.crossing());
  for (int i = 29; i < 100; ++i) {
    EXPECT_EQ(Finding::kNothing, detector.add(i * kPeriod, slope(i))) << i;
  }
}

TEST(StepDetectorTest, StepsWithinTwoWindowsAreOneAndLaterOnesAreTheirOwn) {
  const auto stairs = [](int apart) {
    return [apart](int i) { return (i > 20 ? 1.0 : 0.0) + (i > 20 + apart ? 2.0 : 0.0); };
  };
  EXPECT_EQ(std::vector<double>{22.5}, jumps(steps(0.5, 5), 100, stairs(2)));
  EXPECT_EQ((std::vector<double>{20.5, 31.5}), jumps(steps(0.5, 5), 100, stairs(11)));
}

TEST(StepDetectorTest, StepsWithinTheRefractoryTimeOfTheLastAreNone) {
  Options options = steps(0.5, 3, Direction::kEither);
  options.refractory = 20 * kPeriod;
  EXPECT_EQ((std::vector<double>{20.5, 40.5}), jumps(options, 100, pulse));
  options.refractory = 20 * kPeriod + 1;
  EXPECT_EQ((std::vector<double>{20.5}), jumps(options, 100, pulse));
}

TEST(StepDetectorTest, FindsAllStepsOfFourteenDeviationsInNoiseOfAnySizeAndNoOthers) {
  for (const double sigma : {1e-6, 0.05, 1e4}) {
    Options options = steps(1e-9, 5, Direction::kEither);
    options.noise_factor = 7.0;
    options.noise_samples = 500;
    std::mt19937_64 generator(1);
    std::normal_distribution<double> noise(0.0, sigma);
    // The deviation of a step is sigma sqrt(2/5).
    const double step = 14.0 * std::sqrt(0.4) * sigma;
    const auto signal = [&](int i) { return noise(generator) + (i / 1000 % 2 == 1 ? step : 0.0); };
    const std::vector<double> found = jumps(options, 200'500, signal);
    ASSERT_EQ(200u, found.size()) << sigma;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(1000.0 * (static_cast<double>(i) + 1.0) - 0.5, found[i], 1.1);
    }
  }
}

TEST(StepDetectorTest, FindsNothingBeforeItKnowsTheNoise) {
  Options options = steps(0.5, 1);
  options.noise_factor = 5.0;
  options.noise_samples = 30;
  EXPECT_TRUE(jumps(options, 100, pulse).empty());
  const auto later = [](int i) { return pulse(i) + (i > 31 ? 1.0 : 0.0); };
  EXPECT_EQ(std::vector<double>{31.5}, jumps(options, 100, later));
  // The threshold is the least step that counts where there is no noise.
  options.threshold = 1.1;
  EXPECT_TRUE(jumps(options, 100, later).empty());
}

TEST(DeviationDetectorTest, FindsWhatLeavesTheMedianAndFollowsDrift) {
  Options options;
  options.kind = Kind::kDeviation;
  options.threshold = 0.1;
  options.direction = Direction::kEither;
  options.noise_factor = 8.0;
  options.noise_samples = 100;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise(0.0, 0.02);
  const auto drifting = [&](int i) {
    const double impact = i == 3000 ? 2.0 : i == 6000 ? -2.0 : 0.0;
    return 0.001 * i + noise(generator) + impact;
  };
  const std::vector<double> found = jumps(options, 9000, drifting);
  ASSERT_EQ(2u, found.size());
  EXPECT_NEAR(2999.2, found[0], 0.15);
  EXPECT_NEAR(5999.2, found[1], 0.15);
}

TEST(DeviationDetectorTest, MustComeBackByTheHysteresis) {
  Options options;
  options.kind = Kind::kDeviation;
  options.threshold = 1.0;
  options.noise_factor = 1.0;
  options.noise_samples = 40;
  // Between 50 and 60 it rattles, from 1.5 down to 0.6 and up again; then it comes back to 0.
  const auto rattling = [](int i) {
    if (i >= 50 && i < 60) return i % 2 == 0 ? 1.5 : 0.6;
    return i == 65 ? 1.5 : 0.0;
  };
  EXPECT_EQ(6u, jumps(options, 80, rattling).size());
  options.hysteresis = 0.5;
  EXPECT_EQ(2u, jumps(options, 80, rattling).size());
}

TEST(DeviationDetectorTest, WhatIsLargeWhenTheNoiseBecomesKnownIsNoJump) {
  Options options;
  options.kind = Kind::kDeviation;
  options.threshold = 0.5;
  options.noise_factor = 1.0;
  options.noise_samples = 20;
  const auto high = [](int i) { return i > 20 && i < 30 ? 5.0 : 0.0; };
  EXPECT_TRUE(jumps(options, 25, high).empty());
}

TEST(GuardDetectorTest, ItsFormulaKnowsTheTimeSinceTheLastJump) {
  ExpressionNames names;
  names.x = {"signal", "since"};
  Options options;
  options.kind = Kind::kGuard;
  // It rings after a jump: what follows must be higher, the sooner the more.
  options.guard = std::make_shared<const ExpressionMap>(
      names, std::vector<NamedExpression>{},
      std::vector<NamedExpression>{{"when", "signal - 1 - 4*exp(-since/0.01)"}});
  const auto ringing = [](int i) {
    if (i % 100 == 0) return 4.0;
    return i % 100 < 50 && i % 5 == 0 ? 4.0 * std::exp(-(i % 100) / 10.0) : 0.0;
  };
  const std::vector<double> found = jumps(options, 399, ringing);
  ASSERT_EQ(3u, found.size());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(100.0 * (i + 1) - 0.7, found[i], 0.2);
}

TEST(GuardDetectorTest, WhereItHasNoValueTheSampleIsAsIfItHadNotCome) {
  ExpressionNames names;
  names.x = {"signal", "since"};
  Options options;
  options.kind = Kind::kGuard;
  options.guard = std::make_shared<const ExpressionMap>(
      names, std::vector<NamedExpression>{},
      std::vector<NamedExpression>{{"when", "sqrt(signal) - 1"}});
  JumpDetector detector(options);
  EXPECT_EQ(Finding::kNothing, detector.add(1000, 0.0));
  EXPECT_EQ(Finding::kNotFinite, detector.add(1500, -1.0));
  EXPECT_EQ(Finding::kJump, detector.add(2000, 4.0));
  EXPECT_EQ(1500, detector.crossing());
}

TEST(JumpEnergyTest, MustHaveBeenReachedBetweenTwoJumps) {
  // The signal crosses 0.5 upwards at 10, 30, 50 ...; enough energy comes at 5, 35 and 70.
  const auto square = [](int i) { return i / 10 % 2 == 1 ? 1.0 : 0.0; };
  const auto energy = [](int i) { return i == 5 || i == 35 || i == 70 ? 2.0 : 0.5; };
  Options crossings;
  crossings.threshold = 0.5;
  for (Options options : {crossings, steps(0.5, 3)}) {
    EXPECT_EQ(5u, jumps(options, 99, square, energy).size());
    options.least_energy = 2.0;
    EXPECT_EQ((std::vector<double>{9.5, 49.5, 89.5}), jumps(options, 99, square, energy));
  }
}

TEST(JumpEnergyTest, WhatFollowsAJumpIsNotBeforeIt) {
  const auto step = [](int i) { return i > 20 ? 1.0 : 0.0; };
  const auto after = [](int i) { return i == 21 ? 2.0 : 0.0; };
  const auto before = [](int i) { return i == 20 ? 2.0 : 0.0; };
  Options crossings;
  crossings.threshold = 0.5;
  for (Options options : {crossings, steps(0.5, 3)}) {
    options.least_energy = 1.0;
    EXPECT_TRUE(jumps(options, 50, step, after).empty());
    EXPECT_EQ(1u, jumps(options, 50, step, before).size());
  }
}

TEST(JumpEnergyTest, WhatComesBetweenAStepAndItsDetectionIsAfterIt) {
  // The step at 20.5 is told with sample 25.
  Options options = steps(0.5, 3, Direction::kEither);
  options.least_energy = 1.0;
  for (const int energetic : {21, 22, 25}) {
    const auto energy = [=](int i) { return i == 10 || i == energetic ? 2.0 : 0.0; };
    EXPECT_EQ((std::vector<double>{20.5, 40.5}), jumps(options, 100, pulse, energy)) << energetic;
  }
  const auto before = [](int i) { return i <= 20 ? 2.0 : 0.0; };
  EXPECT_EQ(std::vector<double>{20.5}, jumps(options, 100, pulse, before));
}

TEST(StepDetectorTest, AfterARestartItKnowsNothing) {
  const auto step_after = [](int last) { return [last](int i) { return i > last ? 1.0 : 0.0; }; };
  JumpDetector plain(steps(0.5, 3, Direction::kEither));
  EXPECT_TRUE(jumps(plain, 20, [](int) { return 1.0; }).empty());
  plain.restart();
  EXPECT_EQ(std::vector<double>{10.5}, jumps(plain, 20, step_after(10)));
  EXPECT_EQ(Finding::kOutOfOrder, plain.add(20 * kPeriod, 0.0));

  Options noisy = steps(0.5, 3);
  noisy.noise_factor = 3.0;
  noisy.noise_samples = 25;
  JumpDetector relative(noisy);
  EXPECT_EQ(std::vector<double>{60.5}, jumps(relative, 66, step_after(60)));
  relative.restart();
  EXPECT_TRUE(jumps(relative, 25, step_after(15)).empty());

  Options energetic = steps(0.5, 3);
  energetic.least_energy = 1.0;
  JumpDetector hungry(energetic);
  EXPECT_TRUE(jumps(
                  hungry, 20, [](int) { return 0.0; }, [](int) { return 2.0; })
                  .empty());
  hungry.restart();
  EXPECT_TRUE(jumps(hungry, 20, step_after(10)).empty());
}

TEST(StepDetectorTest, RefusesWhatIsNotFiniteOrTooLarge) {
  JumpDetector detector(steps(0.5, 2));
  EXPECT_EQ(Finding::kNotFinite, detector.add(1, std::nan("")));
  EXPECT_EQ(Finding::kNotFinite, detector.add(1, 1e101));
  EXPECT_EQ(Finding::kNotFinite, detector.add(1, 0.0, std::nan("")));
  EXPECT_EQ(Finding::kNothing, detector.add(1, 0.0));
}

TEST(StepDetectorTest, AllocatesNothing) {
  Options options = steps(0.1, 20, Direction::kEither);
  options.noise_factor = 4.0;
  options.noise_samples = 200;
  JumpDetector detector(options);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> noise(0.0, 0.05);
  const std::size_t before = test::allocations();
  int found = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double value = noise(generator) + (i / 300 % 2 == 1 ? 1.0 : 0.0);
    found += detector.add(i * kPeriod, value) == Finding::kJump ? 1 : 0;
  }
  detector.restart();
  EXPECT_EQ(before, test::allocations());
  EXPECT_EQ(6, found);
}

}  // namespace
}  // namespace sampled_data_observers
