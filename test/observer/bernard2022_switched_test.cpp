// The shipped switched example, in the manner of bernard2022, section 7.3.2.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {
namespace {

constexpr Stamp kFirst = 1000 * kNanosecondsPerSecond;

/// x after `time` in a mode.
Eigen::Vector3d turned(const Eigen::Vector3d& x, int mode, double time) {
  const double c = std::cos(time);
  const double s = std::sin(time);
  if (mode == 1) return {c * x(0) + s * x(1), -s * x(0) + c * x(1), x(2)};
  return {x(0), c * x(1) + s * x(2), -s * x(1) + c * x(2)};
}

class SwitchedExample : public ::testing::Test {
 protected:
  static Estimator make_estimator() {
    const std::string folder =
        std::string(SDO_SOURCE_DIR) + "/config/examples/bernard2022_switched/";
    ObserverConfig config = read_observer_config(
        std::vector<std::string>{folder + "scenario.yaml", folder + "observer.yaml",
                                 folder + "gains_formula.yaml"},
        no_plant_plugins);
    config.options.history = {100 * kNanosecondsPerSecond, 1000};
    return Estimator(config.law, config.options);
  }
  double error(Stamp stamp) {
    EXPECT_EQ(Timeline::Query::kOk, estimator_.estimate_at(stamp, estimate_));
    return (x_ - estimate_.state.head(3)).norm();
  }

  Estimator estimator_ = make_estimator();
  Estimate estimate_ = estimator_.make_estimate();
  Eigen::Vector3d x_{1.0, -0.5, 2.0};
};

TEST_F(SwitchedExample, EachCycleMultipliesTheErrorByTheCosineOfTheSecondMode) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> interval(0.6, 1.4);
  estimator_.restart(kFirst);
  Stamp stamp = kFirst;
  double after_cycle = 0.0;
  double predicted = 1.0;
  for (int k = 0; k < 240; ++k) {
    const int mode = k % 2 == 0 ? 1 : 2;
    const Duration tau = from_seconds(interval(generator));
    stamp += tau;
    x_ = turned(x_, mode, to_seconds(tau));
    const double next = mode == 1 ? 2.0 : 1.0;
    ASSERT_TRUE(
        estimator_.submit({stamp, EventKind::kJump, 0, x_.data(), 1, 0, next}, stamp).used());
    if (mode == 2) predicted *= std::abs(std::cos(to_seconds(tau)));
    if (mode == 1 && k > 0) {
      // The first mode began with an error of x1; from the third on there is none.
      const double now = error(stamp);
      if (k > 2) {
        EXPECT_NEAR(after_cycle * predicted, now, 1e-13);
      }
      after_cycle = now;
      predicted = 1.0;
    }
  }
  EXPECT_LT(error(stamp), 1e-12);
  EXPECT_GT(x_.norm(), 2.0);
}

TEST_F(SwitchedExample, WithoutSwitchesOrOutputsTheErrorStays) {
  estimator_.restart(kFirst);
  const double initial = x_.norm();
  x_ = turned(x_, 1, 50.0);
  EXPECT_NEAR(initial, error(kFirst + from_seconds(50.0)), 1e-12);
  const Stamp stamp = kFirst + from_seconds(50.0);
  ASSERT_TRUE(estimator_.submit({stamp, EventKind::kJump, 0, nullptr, 0, 0, 2.0}, stamp).used());
  x_ = turned(x_, 2, 10.0);
  EXPECT_NEAR(initial, error(stamp + from_seconds(10.0)), 1e-12);
}

}  // namespace
}  // namespace sampled_data_observers
