#include "observer/scheduled_gain_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "plant/linear_plant.h"
#include "support/allocation_counter.h"
#include "support/law_runner.h"
#include "support/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr Duration kMillisecond = 1'000'000;

Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index cols) {
  return Eigen::MatrixXd::Random(rows, cols);
}

Eigen::MatrixXd random_metric(Eigen::Index n) {
  const Eigen::MatrixXd root = random(n, n);
  return root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

/// x' = 0 with sensors of so many outputs each, which measure nothing.
ObserverContext still(Eigen::Index n, const std::vector<Eigen::Index>& outputs) {
  LinearPlantDescription description;
  for (Eigen::Index i = 0; i < n; ++i) description.state_names.push_back("x" + std::to_string(i));
  description.A = Eigen::MatrixXd::Zero(n, n);
  description.B = Eigen::MatrixXd::Zero(n, 0);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    description.sensors.push_back({"s" + std::to_string(i), Eigen::MatrixXd::Zero(outputs[i], n),
                                   std::vector<bool>(static_cast<std::size_t>(outputs[i]))});
  }
  return {make_linear_plant(description), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(0)};
}

ScheduledGains random_gains(const ObserverContext& context,
                            const std::vector<std::vector<double>>& timers) {
  ScheduledGains gains;
  gains.timers = timers;
  const TensorGrid grid(timers);
  for (std::size_t node = 0; node < grid.size(); ++node) gains.P.push_back(random_metric(3));
  for (const Sensor& sensor : context.plant->sensors()) {
    gains.K.emplace_back();
    for (std::size_t node = 0; node < grid.size(); ++node) {
      gains.K.back().push_back(random(3, sensor.outputs()));
    }
  }
  return gains;
}

Eigen::MatrixXd evaluate(const ScheduledGain& gain, std::size_t sensor, Eigen::Index m,
                         const std::vector<double>& tau) {
  Eigen::MatrixXd K(3, m);
  Eigen::VectorXd workspace = Eigen::VectorXd::Constant(gain.workspace_size(), std::nan(""));
  gain.evaluate(sensor, tau.data(), K.data(), workspace.data());
  return K;
}

class TwoSensorsTest : public ::testing::Test {
 protected:
  ObserverContext context_ = still(3, {1, 2});
  ScheduledGains gains_ = random_gains(context_, {{0.0, 0.3, 0.7}, {0.0, 0.2, 0.5, 2.0}});
  ScheduledGain gain_{gains_, *context_.plant};
};

TEST_F(TwoSensorsTest, TheGainAtANodeIsTheOneGivenThere) {
  for (std::size_t node = 0; node < gain_.grid().size(); ++node) {
    const std::vector<double> tau = {gains_.timers[0][node / 4], gains_.timers[1][node % 4]};
    EXPECT_EQ(gains_.K[0][node], evaluate(gain_, 0, 1, tau)) << node;
    EXPECT_EQ(gains_.K[1][node], evaluate(gain_, 1, 2, tau)) << node;
  }
}

TEST_F(TwoSensorsTest, BetweenNodesItIsTheMeanInTheMetricAfterTheSample) {
  // A third of the way from 0.3 to 0.7, three quarters from 0.2 to 0.5: nodes 5, 6, 9 and 10.
  const std::vector<double> tau = {0.3 + 0.4 / 3.0, 0.425};
  const double w5 = 2.0 / 3.0 * 0.25;
  const double w6 = 2.0 / 3.0 * 0.75;
  const double w9 = 1.0 / 3.0 * 0.25;
  const double w10 = 1.0 / 3.0 * 0.75;
  const auto& P = gains_.P;
  // The timer of the first sensor reset: nodes 1 and 2; that of the second: 4 and 8.
  const auto& a = gains_.K[0];
  const Eigen::MatrixXd metric_a = 0.25 * P[1] + 0.75 * P[2];
  const Eigen::MatrixXd sum_a = P[1] * (w5 * a[5] + w9 * a[9]) + P[2] * (w6 * a[6] + w10 * a[10]);
  EXPECT_LT((test::inverse(metric_a) * sum_a - evaluate(gain_, 0, 1, tau)).norm(), 1e-13);
  const auto& b = gains_.K[1];
  const Eigen::MatrixXd metric_b = 2.0 / 3.0 * P[4] + 1.0 / 3.0 * P[8];
  const Eigen::MatrixXd sum_b = P[4] * (w5 * b[5] + w6 * b[6]) + P[8] * (w9 * b[9] + w10 * b[10]);
  EXPECT_LT((test::inverse(metric_b) * sum_b - evaluate(gain_, 1, 2, tau)).norm(), 1e-13);
}

TEST_F(TwoSensorsTest, ItMakesTheJumpOfTheMetricMultiaffine) {
  // P(τ⁺) K_i(τ), which the jump of V has, between two nodes of each timer.
  const auto jump = [&](std::size_t sensor, double first, double second) -> Eigen::MatrixXd {
    double tau[] = {first, second};
    const Eigen::MatrixXd K = evaluate(gain_, sensor, sensor == 0 ? 1 : 2, {first, second});
    tau[sensor] = 0.0;
    const TensorGrid::Interpolation at = gain_.grid().locate(tau);
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3, 3);
    for (std::size_t v = 0; v < at.size; ++v) P += at.weights[v] * gains_.P[at.vertices[v]];
    return P * K;
  };
  for (const std::size_t sensor : {0u, 1u}) {
    const Eigen::MatrixXd low = jump(sensor, 0.3, 0.5);
    const Eigen::MatrixXd high = jump(sensor, 0.3, 2.0);
    const Eigen::MatrixXd right = jump(sensor, 0.7, 0.5);
    const Eigen::MatrixXd corner = jump(sensor, 0.7, 2.0);
    const Eigen::MatrixXd middle = 0.25 * (low + high + right + corner);
    EXPECT_LT((middle - jump(sensor, 0.5, 1.25)).norm(), 1e-13);
    EXPECT_GT((low - corner).norm(), 0.1);
  }
}

TEST_F(TwoSensorsTest, LongerTimesAreTakenAsTheLastNode) {
  EXPECT_EQ(evaluate(gain_, 0, 1, {0.7, 0.3}), evaluate(gain_, 0, 1, {50.0, 0.3}));
  EXPECT_EQ(gains_.K[1][11], evaluate(gain_, 1, 2, {1e9, 3.0}));
}

TEST_F(TwoSensorsTest, TimersStartAtZeroAndAreResetByTheirSensor) {
  test::LawRunner run(std::make_shared<const ScheduledGainObserver>(context_, gains_));
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(3);
  run.sample(1, {1.0, 2.0});
  expected += gains_.K[1][0] * Eigen::Vector2d(1.0, 2.0);
  EXPECT_LT((expected - run.estimate()).norm(), 1e-15);
  run.flow(200 * kMillisecond);
  run.flow(100 * kMillisecond);
  run.sample(0, {1.5});  // both are at 0.3 s
  expected += evaluate(gain_, 0, 1, {0.3, 0.3}) * 1.5;
  EXPECT_LT((expected - run.estimate()).norm(), 1e-14);
  run.sample(0, {0.5});  // at the same time: its own timer is 0
  expected += evaluate(gain_, 0, 1, {0.0, 0.3}) * 0.5;
  EXPECT_LT((expected - run.estimate()).norm(), 1e-14);
  run.flow(100 * kMillisecond);
  run.sample(1, {1.0, 0.0});
  expected += evaluate(gain_, 1, 2, {0.1, 0.4}).col(0);
  EXPECT_LT((expected - run.estimate()).norm(), 1e-14);
}

TEST_F(TwoSensorsTest, NodesOfWholeNanosecondsAreMetExactly) {
  const ScheduledGainObserver law(context_, gains_);
  Eigen::VectorXd state(law.state_size());
  Eigen::VectorXd workspace(law.workspace_size());
  law.initialize(state.data());
  law.flow(700 * kMillisecond, state.data(), workspace.data());
  const double one = 1.0;
  law.reset({1, EventKind::kSample, 0, &one, 1}, state.data(), workspace.data());
  EXPECT_EQ(evaluate(gain_, 0, 1, {0.7, 0.7}), state.head(3));
}

TEST_F(TwoSensorsTest, SamplesAllocateNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Eigen::MatrixXd K(3, 2);
  Eigen::VectorXd workspace(gain_.workspace_size());
  const double tau[] = {0.4, 0.6};
  const std::size_t before = test::allocations();
  gain_.evaluate(0, tau, K.data(), workspace.data());
  gain_.evaluate(1, tau, K.data(), workspace.data());
  EXPECT_EQ(before, test::allocations());
}

TEST_F(TwoSensorsTest, ListsItsGainsByTheirKeys) {
  const LawGains listed = ScheduledGainObserver(context_, gains_).gains();
  EXPECT_EQ(2u + 12u + 24u, listed.all.size());
  EXPECT_EQ(Eigen::RowVector3d(0.0, 0.3, 0.7), listed.find("timers/s0")->value);
  EXPECT_LT((gains_.P[10] - listed.find("P/10")->value).norm(), 1e-15);
  EXPECT_EQ(gains_.K[1][11], listed.find("K/s1/11")->value);
}

TEST(ScheduledGainTest, WithOneSensorItIsPiecewiseLinear) {
  const ObserverContext context = still(3, {2});
  const ScheduledGains gains = random_gains(context, {{0.0, 0.5, 2.0}});
  const ScheduledGain gain(gains, *context.plant);
  const auto& K = gains.K[0];
  EXPECT_EQ(K[1], evaluate(gain, 0, 2, {0.5}));
  EXPECT_LT((0.75 * K[0] + 0.25 * K[1] - evaluate(gain, 0, 2, {0.125})).norm(), 1e-15);
  EXPECT_LT((0.5 * K[1] + 0.5 * K[2] - evaluate(gain, 0, 2, {1.25})).norm(), 1e-15);
}

TEST(ScheduledGainTest, WhereSamplesMayFollowAtOnceZStandsForIt) {
  LinearPlantDescription description;
  description.state_names = {"a", "b", "c"};
  description.A = Eigen::MatrixXd::Zero(3, 3);
  description.B = Eigen::MatrixXd::Zero(3, 0);
  const Eigen::MatrixXd C = random(2, 3);
  description.sensors = {{"s0", C, {false, false}}};
  const ObserverContext context{make_linear_plant(description), Eigen::VectorXd::Zero(3),
                                Eigen::VectorXd::Zero(0)};
  ScheduledGains gains = random_gains(context, {{0.0, 0.5, 2.0}});
  gains.K[0][0] = Eigen::MatrixXd();
  gains.Z = {{random(2, 2), Eigen::MatrixXd(), Eigen::MatrixXd()}};
  const ScheduledGain gain(gains, *context.plant);
  const Eigen::MatrixXd K = evaluate(gain, 0, 2, {0.0});
  EXPECT_LT((gains.P[0] * K - C.transpose() * gains.Z[0][0]).norm(), 1e-13);
  EXPECT_LT((0.75 * K + 0.25 * gains.K[0][1] - evaluate(gain, 0, 2, {0.125})).norm(), 1e-14);
  const LawGains listed = ScheduledGainObserver(context, gains).gains();
  EXPECT_EQ(gains.Z[0][0], listed.find("Z/s0/0")->value);
  EXPECT_EQ(nullptr, listed.find("K/s0/0"));
  std::swap(gains.Z[0][0], gains.Z[0][1]);
  std::swap(gains.K[0][0], gains.K[0][1]);
  EXPECT_THROW(ScheduledGain(gains, *context.plant), std::invalid_argument);
  std::swap(gains.K[0][0], gains.K[0][1]);
  gains.Z[0] = {random(2, 1), Eigen::MatrixXd(), Eigen::MatrixXd()};
  EXPECT_THROW(ScheduledGain(gains, *context.plant), std::invalid_argument);
}

TEST(ScheduledGainTest, ThreeSensorsWithOneGainEachHaveThatEverywhere) {
  const ObserverContext context = still(3, {1, 1, 2});
  ScheduledGains gains = random_gains(context, {{0.0, 1.0}, {0.0, 1.0, 2.0}, {0.0, 3.0}});
  for (auto& of_sensor : gains.K) {
    for (Eigen::MatrixXd& K : of_sensor) K = of_sensor.front();
  }
  const ScheduledGain gain(gains, *context.plant);
  for (const double t : {0.1, 0.9, 1.7}) {
    for (const std::size_t sensor : {0u, 1u, 2u}) {
      const Eigen::MatrixXd& K = gains.K[sensor].front();
      EXPECT_LT((K - evaluate(gain, sensor, K.cols(), {0.3 * t, t, 2.5 - t})).norm(), 1e-14);
    }
  }
}

TEST(ScheduledGainTest, MetricsNextToSingularOnesGiveGainsEverywhere) {
  const ObserverContext context = still(3, {1, 1});
  ScheduledGains gains = random_gains(context, {{0.0, 1.0}, {0.0, 1.0}});
  const auto along = [](const Eigen::Vector3d& v, const Eigen::Vector3d& units) {
    // Scaled to a unit diagonal, its least eigenvalues are 2e-11.
    const Eigen::Matrix3d M = v * v.transpose() + 2e-11 * Eigen::Matrix3d::Identity();
    return Eigen::MatrixXd(units.asDiagonal() * M * units.asDiagonal());
  };
  gains.P[0] = along({1.0, 1.0, 1.0}, {1e3, 1e-3, 1.0});
  gains.P[1] = along({1.0, 1.0, -1.0}, {1e3, 1e-3, 1.0});
  gains.P[2] = along({1.0, 1.0, 1.0}, {2e3, 2e-3, 2.0});
  const ScheduledGain gain(gains, *context.plant);
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.01 * i;
    EXPECT_TRUE(evaluate(gain, 0, 1, {0.5, t}).allFinite());
    EXPECT_TRUE(evaluate(gain, 1, 1, {t, 0.5}).allFinite());
  }
}

std::string fault(const ObserverContext& context, const ScheduledGains& gains) {
  try {
    const ScheduledGainObserver law(context, gains);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no fault";
}

TEST_F(TwoSensorsTest, SaysWhichGainsItCantUse) {
  const auto changed = [&](auto&& change) {
    ScheduledGains gains = gains_;
    change(gains);
    return fault(context_, gains);
  };
  EXPECT_EQ("no fault", changed([](ScheduledGains&) {}));
  EXPECT_EQ("timers must have one entry per sensor",
            changed([](ScheduledGains& g) { g.timers.pop_back(); }));
  EXPECT_EQ("timers/s1 must begin with 0",
            changed([](ScheduledGains& g) { g.timers[1][0] = 0.1; }));
  EXPECT_EQ("nodes of a grid must be finite and strictly increasing",
            changed([](ScheduledGains& g) { g.timers[1][2] = 0.1; }));
  EXPECT_EQ("P must have one matrix per node", changed([](ScheduledGains& g) { g.P.pop_back(); }));
  EXPECT_EQ("P/7 must be positive definite", changed([](ScheduledGains& g) { g.P[7] *= -1.0; }));
  EXPECT_EQ(
      "P/7 must be further from singular: scaled to a unit diagonal, its least eigenvalue is "
      "below 1e-11",
      changed([](ScheduledGains& g) {
        g.P[7].setOnes();
        g.P[7].diagonal().array() += 5e-12;
      }));
  EXPECT_EQ("K must have one entry per sensor", changed([](ScheduledGains& g) { g.K.pop_back(); }));
  EXPECT_EQ("K/s0 must have one matrix per node",
            changed([](ScheduledGains& g) { g.K[0].pop_back(); }));
  EXPECT_EQ("K/s1/3 must have one row per state, one column per output",
            changed([](ScheduledGains& g) { g.K[1][3] = random(3, 1); }));
  EXPECT_EQ("K/s1/3 must be finite, and its product with P",
            changed([](ScheduledGains& g) { g.K[1][3](0, 0) = 1e308 * 10.0; }));
}

}  // namespace
}  // namespace sampled_data_observers
