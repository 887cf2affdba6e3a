// Jumps missed, told though none happened, told twice, and stamped too early or too late, on the
// examples of bernard2022 with linear maps as shipped: how soon the error is where it was.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/example_run.h"
#include "support/recovery.h"

namespace sampled_data_observers::test {
namespace {

constexpr double kMillisecond = 1e-3;

/// 30 ms: at bounces told 20 ms early or late, and where one is made up.
Recovery ball(const std::string& gains, const std::string& observer) {
  return {Example("bernard2022_bouncing_ball", gains), 30 * kMillisecond, observer};
}

/// In the middle between two jumps, to the period of the truth.
double between(const Recovery& example, std::size_t k) {
  return std::round(50.0 * (example.jump(k) + example.jump(k + 1))) / 100.0;
}

// The error falls by a fifth or more with each bounce (certified), whatever it comes from.
TEST(MistakenBounces, AConstantGainRecoversWithinSevenBounces) {
  const Recovery ball = test::ball("gains.yaml", "observer.yaml");
  const double tolerance = 0.5;  // m, m/s; the error is 0.9 before the fourth bounce
  const std::size_t k = 3;
  EXPECT_LT(ball.recovered_at([](ToldJumps& jumps) { jumps.drop(3); }, tolerance),
            ball.jump(k + 7));
  EXPECT_LT(ball.recovered_at([&](ToldJumps& jumps) { jumps.add(between(ball, 3)); }, tolerance),
            ball.jump(k + 7));
  EXPECT_LT(
      ball.recovered_at([](ToldJumps& jumps) { jumps.repeat(3, 2 * kMillisecond); }, tolerance),
      ball.jump(k + 7));
}

TEST(MistakenBounces, JitterCostsAConstantGainNoMoreThanItsTime) {
  const Recovery ball = test::ball("gains.yaml", "observer.yaml");
  for (const int milliseconds : {1, 5, 20}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const ExampleRun run = ball.run(
          [=](ToldJumps& jumps) { jumps.jitter(1, 5, milliseconds * kMillisecond, seed); });
      EXPECT_LT(ball.most(run), 0.05 * milliseconds) << seed;
      EXPECT_LT(ball.recovered_at(run, 0.01 * milliseconds), ball.jump(5 + 3)) << seed;
    }
  }
}

// As the gate of the guarded observer is open, and nothing made up, while the estimate is wrong.
TEST(MistakenBounces, TheGuardChangesNothingWhereNothingIsMistaken) {
  for (const char* gains : {"gains.yaml", "gains_printed.yaml", "gains_kalman.yaml"}) {
    const Recovery plain = ball(gains, "observer.yaml");
    const Recovery guarded = ball(gains, "observer_guarded.yaml");
    EXPECT_EQ(0u, guarded.truthful().refused) << gains;
    EXPECT_LT(plain.most(guarded.truthful()), 1e-9) << gains;
  }
}

// A filter that takes the model to be exact does not forget, so it must not err.
TEST(MistakenBounces, AKalmanFilterAloneDoesNotRecover) {
  const Recovery ball = test::ball("gains_kalman.yaml", "observer.yaml");
  // Then the bounces follow too closely on each other for anything to count.
  constexpr double kEnd = 7.6;  // s
  EXPECT_GT(ball.recovered_at([](ToldJumps& jumps) { jumps.drop(3); }, 0.5), kEnd);
  EXPECT_GT(ball.recovered_at([](ToldJumps& jumps) { jumps.repeat(3, 2 * kMillisecond); }, 0.5),
            kEnd);
}

TEST(MistakenBounces, AGuardedKalmanFilterMakesUpAMissedBounceWithin150Milliseconds) {
  for (const char* gains : {"gains_kalman.yaml", "gains_kalman_jitter.yaml"}) {
    const Recovery ball = test::ball(gains, "observer_guarded.yaml");
    for (const std::size_t k : {3u, 6u, 9u}) {
      EXPECT_LT(ball.recovered_at([=](ToldJumps& jumps) { jumps.drop(k); }, 0.01),
                ball.jump(k) + 0.15)
          << k;
    }
  }
}

// Between later bounces the ball rises no higher than the margin of the gate.
TEST(MistakenBounces, AGuardedKalmanFilterTakesNoFalseBounce) {
  const Recovery ball = test::ball("gains_kalman.yaml", "observer_guarded.yaml");
  for (const std::size_t k : {2u, 3u, 4u}) {
    const ExampleRun run = ball.run([&](ToldJumps& jumps) { jumps.add(between(ball, k)); });
    EXPECT_EQ(1u, run.refused) << k;
    EXPECT_LT(ball.most(run), 1e-9) << k;
  }
}

TEST(MistakenBounces, AGuardedKalmanFilterTakesABounceOnce) {
  const Recovery ball = test::ball("gains_kalman.yaml", "observer_guarded.yaml");
  for (const std::size_t k : {3u, 6u, 9u}) {
    const ExampleRun run = ball.run([=](ToldJumps& jumps) { jumps.repeat(k, 2 * kMillisecond); });
    EXPECT_EQ(1u, run.refused) << k;
    EXPECT_LT(ball.most(run), 1e-9) << k;
  }
}

TEST(MistakenBounces, AKalmanFilterThatKnowsOfJitterRecoversInThreeBounces) {
  const Recovery ball = test::ball("gains_kalman_jitter.yaml", "observer_guarded.yaml");
  for (const int milliseconds : {1, 5, 20}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const ExampleRun run = ball.run(
          [=](ToldJumps& jumps) { jumps.jitter(1, 5, milliseconds * kMillisecond, seed); });
      EXPECT_LT(ball.most(run), 0.05 * milliseconds) << seed;
      EXPECT_LT(ball.recovered_at(run, 0.001 * milliseconds), ball.jump(5 + 3)) << seed;
    }
  }
}

// So a replay, in which nothing is late, gives what was estimated live.
TEST(MistakenBounces, WhatIsMadeUpAndRefusedIsTheSameHoweverLateTheEventsAre) {
  Example example("bernard2022_bouncing_ball", "gains_kalman_jitter.yaml");
  example.tell([](ToldJumps& jumps) {
    jumps.drop(3);
    jumps.repeat(5, 2 * kMillisecond);
    jumps.add(4.2);
    jumps.jitter(2, 8, 20 * kMillisecond);
  });
  const ExampleRun at_once = example.run("scenario.yaml", "observer_guarded.yaml");
  example.change_scenario([](Scenario& scenario) {
    scenario.jumps->delivery.shortest = kNanosecondsPerSecond / 10;
    scenario.jumps->delivery.longest = kNanosecondsPerSecond;
  });
  const ExampleRun late = example.run("scenario.yaml", "observer_guarded.yaml");
  EXPECT_EQ(2u, at_once.refused);
  EXPECT_TRUE(are_same(at_once, late));
}

// Nobody tells of the bounces from the ninth on. They end at 7.97 s.
TEST(MistakenBounces, ARestingEstimateLiesStillBehindTheLastBounce) {
  Example example("bernard2022_bouncing_ball", "gains_kalman_jitter.yaml");
  example.tell([](ToldJumps& jumps) {
    for (std::size_t k = 8; k < 30; ++k) jumps.drop(k);
  });
  const ExampleRun guarded = example.run("scenario_noisy.yaml", "observer_guarded.yaml");
  const ExampleRun resting = example.run("scenario_noisy.yaml", "observer_resting.yaml");
  EXPECT_GT(guarded.error.from(8.0).median(), 0.2);
  // It falls through the ground by the margin until each of them is made up.
  EXPECT_LT(resting.error.component(0).from(6.5).max(), 0.35);
  EXPECT_EQ(0.0, resting.error.from(8.0).max());
}

TEST(MistakenBounces, ARestingEstimateIsTheGuardedOneUntilItRests) {
  const Recovery guarded = ball("gains_kalman_jitter.yaml", "observer_guarded.yaml");
  const Recovery resting = ball("gains_kalman_jitter.yaml", "observer_resting.yaml");
  for (std::size_t i = 0; i < guarded.truthful().estimate.size(); ++i) {
    if (guarded.truthful().estimate.time(i) > 7.0) break;
    ASSERT_EQ(guarded.truthful().estimate.value(i), resting.truthful().estimate.value(i));
  }
}

/// Its error is below 1e-4 m before the tenth jump, at about 37 s.
Recovery impulsive(const std::string& gains) {
  return {Example("bernard2022_impulsive", gains), 30 * kMillisecond, "observer.yaml"};
}

// It can jump at any time, so nothing is to be seen of a mistake: x3, the position at the last
// jump, is wrong until the next one. The rest the observer forgets as it does any error.
TEST(MistakenImpulses, TheNextJumpsTellWhatTheLastOneWas) {
  for (const char* gains : {"gains.yaml", "gains_kalman.yaml"}) {
    const Recovery example = impulsive(gains);
    const ExampleRun missed = example.run([](ToldJumps& jumps) { jumps.drop(9); });
    const ExampleRun added = example.run([&](ToldJumps& jumps) { jumps.add(between(example, 9)); });
    const ExampleRun doubled =
        example.run([](ToldJumps& jumps) { jumps.repeat(9, 2 * kMillisecond); });
    for (const ExampleRun* run : {&missed, &added, &doubled}) {
      EXPECT_GT(example.most(*run), 5e-4) << gains;
      EXPECT_LT(example.recovered_at(*run, 5e-4), example.jump(11) + 1e-9) << gains;
    }
  }
}

TEST(MistakenImpulses, JitterIsForgottenInThreeJumps) {
  const Recovery example = impulsive("gains.yaml");
  for (const int milliseconds : {1, 5, 20}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const ExampleRun run = example.run(
          [=](ToldJumps& jumps) { jumps.jitter(9, 14, milliseconds * kMillisecond, seed); });
      EXPECT_LT(example.most(run), 2e-3 * milliseconds) << seed;
      EXPECT_LT(example.recovered_at(run, 2e-4 * milliseconds), example.jump(14 + 3)) << seed;
    }
  }
}

Recovery switched(const std::string& gains) {
  return {Example("bernard2022_switched", gains), 30 * kMillisecond, "observer.yaml"};
}

// From the next switch on the mode is right again; the error then falls as at the start.
TEST(MistakenSwitches, TheErrorIsForgottenInFifteenSwitches) {
  for (const char* gains : {"gains.yaml", "gains_formula.yaml"}) {
    const Recovery example = switched(gains);
    const double tolerance = 0.05;  // of a state of size 2.3
    const std::size_t k = 20;       // even: into mode 2
    EXPECT_LT(example.recovered_at([](ToldJumps& jumps) { jumps.drop(20); }, tolerance),
              example.jump(k + 15))
        << gains;
    EXPECT_LT(example.recovered_at([&](ToldJumps& jumps) { jumps.add(between(example, 20), 1); },
                                   tolerance),
              example.jump(k + 15))
        << gains;
    EXPECT_LT(example.recovered_at([](ToldJumps& jumps) { jumps.repeat(20, 2 * kMillisecond); },
                                   tolerance),
              example.jump(k + 15))
        << gains;
  }
}

TEST(MistakenSwitches, JitterCostsNoMoreThanItsTime) {
  const Recovery example = switched("gains.yaml");
  for (const int milliseconds : {1, 5, 20}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const ExampleRun run = example.run(
          [=](ToldJumps& jumps) { jumps.jitter(20, 29, milliseconds * kMillisecond, seed); });
      EXPECT_LT(example.most(run), 5e-3 * milliseconds) << seed;
      EXPECT_LT(example.recovered_at(run, 4e-4 * milliseconds), example.jump(29 + 15)) << seed;
    }
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
