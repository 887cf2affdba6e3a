// The examples of bernard2022 with linear maps, as shipped: example 5.5, the bouncing ball of
// section 7.1 and a switched plant in the manner of section 7.3.2.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/example_run.h"

namespace sampled_data_observers::test {
namespace {

// Example 5.5, (16): observable by flow and jumps together only.
TEST(Bernard2022Impulsive, EachJumpMultipliesTheErrorByItsInterval) {
  const ExampleRun run = Example("bernard2022_impulsive", kPrinted).from_zero().run();
  ASSERT_GT(run.jumps.size(), 20u);
  ASSERT_EQ(10001u, run.error.size());
  // Until the first jump e = (3 - 1.5 t, -1.5, 2); there it is mapped to (0, e2 - 0.2259 e1, 0).
  const double first = run.jumps.front().time;
  double e2 = -1.5 - 0.2259 * (3.0 - 1.5 * first);
  double since = first;
  std::size_t j = 1;
  for (const double t : {0.0, 0.5 * first}) {
    EXPECT_NEAR(2.0, run.error.from(t).component(2).value(0)(0), 1e-12);
  }
  for (std::size_t k = 0; k < run.error.size(); ++k) {
    const double t = run.error.time(k);
    if (t < first) continue;
    for (; j < run.jumps.size() && run.jumps[j].time <= t; ++j) {
      const double interval = run.jumps[j].time - since;
      ASSERT_TRUE(2.0 - 1e-9 <= interval && interval <= 5.0 + 1e-9) << interval;
      e2 *= 1.0 - 0.2259 * interval;
      since = run.jumps[j].time;
    }
    // x1 reaches 50: rounding leaves parts in 1e15 of it at each jump.
    ASSERT_NEAR(e2, run.error.value(k)(1), 1e-9 * std::abs(e2) + 1e-12) << t;
    ASSERT_NEAR(e2 * (t - since), run.error.value(k)(0), 1e-9) << t;
    ASSERT_NEAR(0.0, run.error.value(k)(2), 1e-9) << t;
  }
}

TEST(Bernard2022Impulsive, TheErrorVanishes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ExampleRun run = Example("bernard2022_impulsive", kPrinted).from_zero().seed(seed).run();
    EXPECT_GT(run.error.max(), 3.0) << seed;
    EXPECT_LT(run.error.max(), 8.0) << seed;
    EXPECT_LT(run.error.from(32.0).max(), 1e-3) << seed;
    EXPECT_LT(run.error.from(50.0).max(), 1e-6) << seed;
  }
  const ExampleRun as_shipped = Example("bernard2022_impulsive", kPrinted).run();
  EXPECT_LT(as_shipped.error.from(32.0).max(), 1e-3);
  EXPECT_LT(as_shipped.error.from(50.0).max(), 1e-6);
}

/// The ball in closed form: rho = 0.1, lambda = 0.8, g = 9.81.
class Ball {
 public:
  void flow(double t) {
    const double decay = std::exp(-kRho * t);
    const double moved = (1.0 - decay) / kRho;
    height_ += velocity_ * moved - kG / kRho * (t - moved);
    velocity_ = velocity_ * decay - kG * moved;
  }
  /// Time until it falls to the ground.
  double time_to_impact() const {
    double low = 1e-4;
    double high = 3.0;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      Ball later = *this;
      later.flow(middle);
      (later.height_ > 0.0 ? low : high) = middle;
    }
    return low;
  }
  void bounce() {
    height_ = -height_;
    velocity_ *= -0.8;
  }
  Eigen::Vector2d state() const { return {height_, velocity_}; }

 private:
  static constexpr double kRho = 0.1;
  static constexpr double kG = 9.81;
  double height_ = 5.0;
  double velocity_ = 0.0;
};

/// The errors after each jump.
std::vector<Eigen::Vector2d> errors_after_bounces(const ExampleRun& run) {
  std::vector<Eigen::Vector2d> errors;
  Ball ball;
  double now = 0.0;
  for (const ExampleRun::Jump& jump : run.jumps) {
    ball.flow(jump.time - now);
    now = jump.time;
    ball.bounce();
    errors.push_back(jump.estimate - ball.state());
  }
  return errors;
}

// Section 7.1, figure 2: up to the Zeno point.
TEST(Bernard2022BouncingBall, BouncesAsInClosedFormUntilTheZenoPoint) {
  const ExampleRun run = Example("bernard2022_bouncing_ball", kPrinted).run();
  ASSERT_EQ(33u, run.jumps.size());
  Ball ball;
  double now = 0.0;
  for (const ExampleRun::Jump& jump : run.jumps) {
    const double flowed = ball.time_to_impact();
    ball.flow(flowed);
    ball.bounce();
    now += flowed;
    EXPECT_NEAR(now, jump.time, 1e-6);
    ASSERT_EQ(1u, jump.values.size());
    EXPECT_NEAR(0.0, jump.values[0], 1e-7);
  }
  EXPECT_NEAR(1.02692, run.jumps[0].time, 1e-5);
  EXPECT_NEAR(7.12414, run.jumps[9].time, 1e-5);
  EXPECT_EQ(Simulator::End::kZeno, run.end);
  EXPECT_NEAR(7.96345, run.end_time, 1e-4);
}

TEST(Bernard2022BouncingBall, TheErrorShrinksWithEachBounce) {
  struct Expected {
    bool from_zero;
    std::vector<double> after;
    double last;
  };
  for (const Expected& expected :
       {Expected{true,
                 {.6896, .3680, .2182, .1391, .09354, .06541, .04711, .03471, .02602, .01977},
                 9.57e-5},
        Expected{false,
                 {8.174, 4.363, 2.586, 1.649, 1.109, .7753, .5584, .4114, .3083, .2344},
                 1.13e-3}}) {
    Example example("bernard2022_bouncing_ball", kPrinted);
    if (expected.from_zero) example.from_zero();
    const ExampleRun run = example.run();
    const std::vector<Eigen::Vector2d> errors = errors_after_bounces(run);
    ASSERT_EQ(33u, errors.size());
    for (std::size_t j = 0; j < errors.size(); ++j) {
      EXPECT_NEAR(0.0, errors[j](0), 1e-6) << j;  // the observer takes the height at the impact
      if (j > 0) {
        EXPECT_LT(errors[j].norm(), errors[j - 1].norm()) << j;
      }
      if (j < expected.after.size()) {
        EXPECT_NEAR(expected.after[j], errors[j].norm(), 0.01 * expected.after[j]) << j;
      }
    }
    EXPECT_NEAR(expected.last, errors.back().norm(), 0.01 * expected.last);
    EXPECT_LT(run.error.from(6.0).max(), expected.from_zero ? 0.15 : 1.1);
    EXPECT_LT(run.error.from(expected.from_zero ? 7.6 : 7.65).max(),
              expected.from_zero ? 0.02 : 0.15);
  }
}

TEST(Bernard2022Switched, ConvergesBySwitching) {
  const ExampleRun run = Example("bernard2022_switched", "gains_formula.yaml").from_zero().run();
  EXPECT_GT(run.jumps.size(), 50u);
  EXPECT_NEAR(std::sqrt(5.25), run.error.at(0.0), 1e-6);
  EXPECT_GT(run.error.at(5.0), 1.0);
  EXPECT_LT(run.error.from(20.0).max(), 0.1);
  EXPECT_LT(run.error.from(30.0).max(), 1e-3);
  EXPECT_LT(run.error.from(50.0).max(), 1e-6);
}

TEST(Bernard2022Switched, ConvergesWithTheGainsOfMetrics) {
  const ExampleRun run = Example("bernard2022_switched", "gains_metric.yaml").from_zero().run();
  EXPECT_GT(run.jumps.size(), 50u);
  EXPECT_GT(run.error.at(0.0), 2.0);
  EXPECT_LT(run.error.from(40.0).max(), 1e-3);
}

TEST(Bernard2022Switched, StaysUndeterminedWithoutSwitches) {
  const ExampleRun run = Example("bernard2022_switched", "gains_formula.yaml")
                             .from_zero()
                             .change_scenario([](Scenario& scenario) { scenario.jumps.reset(); })
                             .run();
  ASSERT_EQ(6001u, run.error.size());
  for (std::size_t k = 0; k < run.error.size(); ++k) {
    ASSERT_NEAR(std::sqrt(5.25), run.error.value(k).norm(), 1e-9) << run.error.time(k);
  }
}

TEST(Bernard2022Switched, NoModeAloneShowsTheState) {
  for (const int mode : {1, 2}) {
    const ExampleRun run =
        Example("bernard2022_switched", "gains_formula.yaml")
            .from_zero()
            .change_scenario([=](Scenario& scenario) { scenario.jumps->modes = {mode}; })
            .run();
    EXPECT_GT(run.jumps.size(), 50u);
    // The first jump leaves mode 1, the others lead from a mode into itself. They tell x1, and in
    // mode 1 x2; what is left stays, x3 = 2 in mode 1, x2 and x3 in mode 2.
    EXPECT_LT(run.error.from(5.0).component(0).max(), 1e-9);
    EXPECT_GT(run.error.at(10.0), 1.9);
    EXPECT_NEAR(run.error.at(10.0), run.error.at(60.0), 1e-9);
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
