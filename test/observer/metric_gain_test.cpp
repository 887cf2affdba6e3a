#include "observer/metric_gain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <vector>

#include "linear_algebra/matrix_functions.h"
#include "observer/switched_observer.h"
#include "sampled_data_observers/observer/synchronized_observer.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

constexpr auto kMeasuredAtJumps = SensorTiming::kAtJumps;

Eigen::MatrixXd three_by_three(std::initializer_list<double> rows) {
  Eigen::MatrixXd transposed(3, 3);
  std::copy(rows.begin(), rows.end(), transposed.data());
  return transposed.transpose();
}

struct Example {
  Eigen::MatrixXd A = three_by_three({0.1, 1, 0, -1, 0, 0.3, 0.2, 0, -0.4});
  Eigen::MatrixXd A_d = three_by_three({1, 0, 0.5, 0, -0.8, 0, 0.1, 0, 1});
  Eigen::MatrixXd H = three_by_three({1, 0, 0.2, 0, 1, -1, 0, 0, 0}).topRows(2);
  Eigen::MatrixXd P = three_by_three({2, -0.5, 0.1, -0.5, 1, 0.3, 0.1, 0.3, 3});

  Eigen::MatrixXd gain(double tau) const {
    const Eigen::MatrixXd flown = exponential_of(A * tau);
    const Eigen::MatrixXd covariance = flown * inverse_of(P) * flown.transpose();
    return A_d * covariance * H.transpose() * inverse_of(H * covariance * H.transpose());
  }
};

Eigen::MatrixXd evaluated(const MetricGain& gain, Duration tau) {
  Eigen::MatrixXd L(3, 2);
  Eigen::VectorXd workspace(gain.workspace_size());
  const std::size_t before = test::allocations();
  gain.evaluate(tau, L.data(), workspace.data());
  EXPECT_EQ(before, test::allocations());
  return L;
}

TEST(MetricGainTest, IsTheProjectionAlongTheMetricOfTheTimeAndThenTheJump) {
  const Example example;
  const MetricGain gain(example.A, example.A_d, example.H, example.P);
  for (const double tau : {0.0, 0.3, 1.7, 6.0}) {
    EXPECT_LT((evaluated(gain, from_seconds(tau)) - example.gain(tau)).norm(), 1e-11) << tau;
  }
}

TEST(MetricGainTest, IsThatOfNoTimeWhereTheFlowOverflows) {
  Example example;
  example.A(0, 0) = 1000.0;
  const MetricGain gain(example.A, example.A_d, example.H, example.P);
  EXPECT_EQ(evaluated(gain, from_seconds(1000.0)), evaluated(gain, 0));
}

TEST(MetricGainTest, RefusesOutputsThatDependOnEachOther) {
  Example example;
  example.H.row(1) = 2.0 * example.H.row(0);
  EXPECT_THROW(MetricGain(example.A, example.A_d, example.H, example.P), std::invalid_argument);
}

/// The example as a plant of one mode, or of two alike.
ObserverContext plant_of(const Example& example, bool switches) {
  const auto map = [](const Eigen::MatrixXd& M) { return std::make_shared<const AffineMap>(M); };
  PlantDescription plant;
  plant.state_names = {"a", "b", "c"};
  plant.sensors = {{"first", kMeasuredAtJumps, {false}}, {"second", kMeasuredAtJumps, {false}}};
  PlantMode mode;
  mode.flow = map(example.A);
  mode.jump = map(example.A_d);
  mode.outputs = {map(example.H.row(0)), map(example.H.row(1))};
  plant.modes = {mode};
  if (switches) {
    plant.modes.push_back(mode);
    plant.modes[0].label = 1;
    plant.modes[1].label = 2;
  }
  return {std::make_shared<const Plant>(plant), Eigen::Vector3d(1.0, -2.0, 0.5),
          Eigen::VectorXd(0)};
}

Eigen::Vector3d after_jump(const PlantObserver& law, std::vector<double> outputs, double tau) {
  Eigen::VectorXd state(law.state_size());
  Eigen::VectorXd workspace(law.workspace_size());
  law.initialize(state.data());
  law.flow(from_seconds(tau), state.data(), workspace.data());
  Event jump;
  jump.stamp = 1;
  jump.kind = EventKind::kJump;
  jump.values = outputs.data();
  jump.size = static_cast<Eigen::Index>(outputs.size());
  if (law.plant().switches()) jump.mode = 2;
  EXPECT_EQ(Effect::kApplied, law.reset(jump, state.data(), workspace.data()));
  return state.head(3);
}

TEST(MetricGainTest, CorrectsJumpsOfBothObserversWhereAllOutputsAreKnown) {
  const Example example;
  SwitchedGains switched;
  switched.metrics = {example.P, 2.0 * example.P};
  SynchronizedGains synchronized;
  synchronized.L_c = {{}, {}};
  synchronized.L_d = {Eigen::MatrixXd::Zero(3, 1), Eigen::MatrixXd::Zero(3, 1)};
  synchronized.metric = example.P;
  const SwitchedObserver first(plant_of(example, true), switched);
  const SynchronizedObserver second(plant_of(example, false), synchronized);
  const double tau = 0.8;
  const Eigen::Vector3d x = exponential_of(example.A * tau) * Eigen::Vector3d(1.0, -2.0, 0.5);
  const Eigen::Vector2d y(0.7, -0.1);
  const Eigen::Vector3d expected = example.A_d * x + example.gain(tau) * (y - example.H * x);
  for (const PlantObserver* law :
       {static_cast<const PlantObserver*>(&first), static_cast<const PlantObserver*>(&second)}) {
    EXPECT_LT((after_jump(*law, {y(0), y(1)}, tau) - expected).norm(), 1e-12);
    EXPECT_LT((after_jump(*law, {}, tau) - example.A_d * x).norm(), 1e-12);
  }
  switched.metrics[1](0, 1) += 0.1;
  EXPECT_THROW(SwitchedObserver(plant_of(example, true), switched), std::invalid_argument);
  synchronized.metric = -example.P;
  EXPECT_THROW(SynchronizedObserver(plant_of(example, false), synchronized), std::invalid_argument);
  synchronized.metric = example.P;
  synchronized.L_d[0](0) = 1.0;
  EXPECT_THROW(SynchronizedObserver(plant_of(example, false), synchronized), std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
