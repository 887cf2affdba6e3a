#include "sampled_data_observers/observer/synchronized_observer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sampled_data_observers/runtime/estimator.h"
#include "support/law_runner.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::LawRunner;
using test::OwnedEvent;

std::shared_ptr<const VectorMap> map(const Eigen::MatrixXd& M) {
  return std::make_shared<const AffineMap>(M);
}

/// System (16) of bernard2022: neither flow nor jumps alone are detectable. Sensor 0 measures x1
/// continuously, sensor 1 at jumps.
std::shared_ptr<const Plant> system_16() {
  PlantDescription plant;
  plant.state_names = {"x1", "x2", "x3"};
  plant.sensors = {{"c", SensorTiming::kContinuous, {false}},
                   {"d", SensorTiming::kAtJumps, {false}}};
  PlantMode mode;
  Eigen::Matrix3d A_c = Eigen::Matrix3d::Zero();
  A_c(0, 1) = 1.0;
  Eigen::Matrix3d A_d = Eigen::Matrix3d::Zero();
  A_d(0, 0) = A_d(1, 1) = A_d(2, 0) = 1.0;
  mode.flow = map(A_c);
  mode.jump = map(A_d);
  mode.outputs = {map(Eigen::RowVector3d(1.0, 0.0, 0.0)), map(Eigen::RowVector3d(1.0, 0.0, 0.0))};
  plant.modes = {mode};
  return std::make_shared<const Plant>(plant);
}

std::shared_ptr<const ObserverLaw> law(const Eigen::Vector3d& L_c, const Eigen::Vector3d& L_d,
                                       std::vector<OutputInjection> injections = {}) {
  SynchronizedGains gains;
  gains.L_c = {L_c, {}};
  gains.L_d = {{}, L_d};
  gains.output_injections = std::move(injections);
  return std::make_shared<const SynchronizedObserver>(
      ObserverContext{system_16(), Eigen::Vector3d(0.5, -0.25, 2.0), Eigen::VectorXd::Zero(0)},
      gains);
}

TEST(SynchronizedObserverTest, FlowsWithTheInnovationOfTheOutputHeld) {
  LawRunner runner(law({3.0, 2.0, 0.0}, Eigen::Vector3d::Zero()));
  runner.flow(kSecond);  // no output yet: the plant alone
  EXPECT_NEAR(0.25, runner.estimate()(0), 1e-15);
  runner.output(0, {1.0});
  // e = x - (1, 0): e' = [-3 1; -2 0] e with eigenvalues -1 and -2.
  const Eigen::Vector2d e0(0.25 - 1.0, -0.25);
  runner.flow(kSecond);
  const double a = std::exp(-1.0);
  const double b = std::exp(-2.0);
  EXPECT_NEAR(1.0 + (2 * b - a) * e0(0) + (a - b) * e0(1), runner.estimate()(0), 1e-14);
  EXPECT_NEAR(-2 * (a - b) * e0(0) + (2 * a - b) * e0(1), runner.estimate()(1), 1e-14);
}

TEST(SynchronizedObserverTest, JumpsWithTheInnovationOfTheOutputBeforeTheJump) {
  LawRunner runner(law(Eigen::Vector3d::Zero(), {1.0, 0.2259, 1.0}));
  runner.jump({0.9});
  EXPECT_LT((Eigen::Vector3d(0.9, -0.25 + 0.2259 * 0.4, 0.9) - runner.estimate()).norm(), 1e-15);
  runner.flow(kSecond);
  const double x1 = runner.estimate()(0);
  runner.jump();  // without its output: the plant's own
  EXPECT_EQ(x1, runner.estimate()(0));
  EXPECT_EQ(x1, runner.estimate()(2));
}

TEST(SynchronizedObserverTest, AnOutputOfEqualStampJoinsTheJumpWhicheverComesFirst) {
  LawRunner in_event(law({1.0, 0.5, 0.0}, {1.0, 0.2259, 1.0}));
  in_event.output(0, {0.3});
  in_event.flow(kSecond / 3);
  in_event.jump({0.9});
  in_event.flow(kSecond);
  LawRunner beside(law({1.0, 0.5, 0.0}, {1.0, 0.2259, 1.0}));
  beside.output(0, {0.3});
  beside.flow(kSecond / 3);
  beside.jump();
  beside.jump_output(1, {0.9});
  beside.flow(kSecond);
  EXPECT_EQ(in_event.estimate(), beside.estimate());

  Estimator::Options options;
  options.history = {10 * kSecond, 100};
  options.sampling = {kSecond, kSecond};
  std::vector<OwnedEvent> events = {{kStart, EventKind::kOutput, 0, {0.3}},
                                    {kStart + kSecond / 3, EventKind::kJump, 0, {}},
                                    {kStart + kSecond / 3, EventKind::kJumpOutput, 1, {0.9}}};
  std::sort(events.begin(), events.end(), [](const OwnedEvent& a, const OwnedEvent& b) {
    return compare(a.view(), b.view()) < 0;
  });
  do {
    Estimator estimator(law({1.0, 0.5, 0.0}, {1.0, 0.2259, 1.0}), options);
    for (const OwnedEvent& event : events) {
      ASSERT_TRUE(estimator.submit(event.view(), kStart + kSecond).used());
    }
    Estimate estimate = estimator.make_estimate();
    ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + 4 * kSecond / 3, estimate));
    EXPECT_LT((in_event.estimate() - estimate.state.head(3)).norm(), 1e-15);
  } while (std::next_permutation(
      events.begin(), events.end(),
      [](const OwnedEvent& a, const OwnedEvent& b) { return compare(a.view(), b.view()) < 0; }));
}

TEST(SynchronizedObserverTest, AnOutputWithoutAJumpSaysNothing) {
  LawRunner runner(law(Eigen::Vector3d::Zero(), {1.0, 0.2259, 1.0}));
  runner.jump_output(1, {5.0});
  EXPECT_EQ(Eigen::Vector3d(0.5, -0.25, 2.0), runner.estimate());
  runner.jump();
  runner.flow(1);
  const Eigen::VectorXd before = runner.estimate();
  runner.jump_output(1, {5.0});  // a nanosecond too late
  EXPECT_EQ(before, runner.estimate());
}

TEST(SynchronizedObserverTest, OutputInjectionTakesTheStateFromTheOutput) {
  // x1' = x2 is untouched, but with x2 taken from the output it is the output that drives x1.
  LawRunner runner(law(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), {{1, 0}}));
  runner.output(0, {4.0});
  runner.flow(kSecond);
  EXPECT_NEAR(4.5, runner.estimate()(0), 1e-15);
  EXPECT_EQ(-0.25, runner.estimate()(1));
}

TEST(SynchronizedObserverTest, FindsTheStateOfSystem16ThatNeitherFlowNorJumpsShowAlone) {
  // Example 5.5: jumps 2 to 5 s apart.
  LawRunner runner(law(Eigen::Vector3d::Zero(), {1.0, 0.2259, 1.0}));
  Eigen::Vector3d x(1.0, -0.5, 3.0);
  const double initial_error = (x - runner.estimate()).norm();
  for (int k = 0; k < 100; ++k) {
    const double tau = k % 2 == 0 ? 2.0 : 5.0;
    x(0) += tau * x(1);
    runner.flow(from_seconds(tau));
    runner.jump({x(0)});
    x(2) = x(0);
  }
  EXPECT_LT((x - runner.estimate()).norm(), 1e-9 * initial_error);
}

TEST(SynchronizedObserverTest, RefusesWhatDoesNotFit) {
  const ObserverContext context{system_16(), Eigen::Vector3d::Zero(), Eigen::VectorXd::Zero(0)};
  SynchronizedGains gains;
  gains.L_c = {Eigen::Vector3d::Zero(), {}};
  gains.L_d = {{}, Eigen::Vector2d::Zero()};
  EXPECT_THROW(SynchronizedObserver(context, gains), std::invalid_argument);
  gains.L_d = {{}, Eigen::Vector3d::Zero()};
  EXPECT_NO_THROW(SynchronizedObserver(context, gains));
  gains.output_injections = {{0, 1}};  // a sensor that measures at jumps only
  EXPECT_THROW(SynchronizedObserver(context, gains), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
