// The hybrid Kalman filter, (40) in its standard form, where bernard2022 has constant gains:
// example 5.5, and the ball of section 7.1, where the paper remarks that one could use it.
#include <gtest/gtest.h>

#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

constexpr char kKalman[] = "gains_kalman.yaml";

// Three jumps determine the state, and so leave little of the initial error. Then the gain goes to
// zero, since the model is taken to be exact: in the end the constant gain is better.
TEST(Bernard2022ImpulsiveKalman, ConvergesInThreeJumps) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Example example("bernard2022_impulsive", kKalman);
    const ExampleRun run = example.from_zero().seed(seed).run();
    EXPECT_EQ(0u, run.refused);
    EXPECT_GT(run.error.max(), 3.0) << seed;
    EXPECT_LT(run.error.max(), 8.0) << seed;
    EXPECT_LT(run.error.from(12.0).max(), 1e-3) << seed;  // constant gain: from 32 s on
    EXPECT_LT(run.error.from(99.0).max(), 1e-5) << seed;
  }
  const ExampleRun as_shipped = Example("bernard2022_impulsive", kKalman).run();
  EXPECT_LT(as_shipped.error.from(12.0).max(), 1e-3);
}

TEST(Bernard2022ImpulsiveKalman, IsFasterThanTheConstantGainAtFirst) {
  const ExampleRun kalman = Example("bernard2022_impulsive", kKalman).run();
  const ExampleRun constant = Example("bernard2022_impulsive", kPrinted).run();
  EXPECT_LT(2.0 * kalman.error.last_above(1e-3), constant.error.last_above(1e-3));
  EXPECT_LT(constant.error.at(100.0), kalman.error.at(100.0));
}

// Two bounces determine the state.
TEST(Bernard2022BouncingBallKalman, ConvergesInTwoBounces) {
  for (const bool from_zero : {true, false}) {
    Example filter("bernard2022_bouncing_ball", kKalman);
    Example printed("bernard2022_bouncing_ball", kPrinted);
    if (from_zero) {
      filter.from_zero();
      printed.from_zero();
    }
    const ExampleRun kalman = filter.run();
    const ExampleRun constant = printed.run();
    ASSERT_EQ(33u, kalman.jumps.size());
    EXPECT_EQ(0u, kalman.refused);
    const double second = kalman.jumps[1].time;
    EXPECT_NEAR(2.54980, second, 1e-5);
    EXPECT_GT(kalman.error.from(2.0, second).max(), 0.5);
    EXPECT_LT(kalman.error.from(2.55).max(), 1e-3);
    EXPECT_LT(kalman.error.from(7.0).max(), 1e-4);
    EXPECT_GT(constant.error.from(2.55).max(), 0.3);
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
