// What predicting over 10 ms and correcting by three outputs cost a Kalman filter of 15 states:
// pose, velocity and acceleration of a body, as in robot_localization, by formulas; and a linear
// plant of that size, and the first with sigma points. Compare within one run: machines differ. The
// counter `allocations` is the number of heap allocations per operation.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <memory>
#include <utility>

#include "allocations.h"
#include "body_plant.h"
#include "observer/hybrid_kalman_filter.h"
#include "observer/unscented_kalman_filter.h"

namespace sampled_data_observers {
namespace {

constexpr Eigen::Index kStates = 15;
constexpr Duration kStep = kNanosecondsPerSecond / 100;
/// About as long, with more digits in base 64.
constexpr Duration kUneven = 10'345'678;

std::shared_ptr<const VectorMap> linear_flow() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(kStates, kStates);
  A.topRightCorner(12, 12).diagonal().setOnes();
  return std::make_shared<const AffineMap>(A);
}

template <class Law>
std::shared_ptr<const ObserverLaw> filter(std::shared_ptr<const VectorMap> flow) {
  PlantDescription plant;
  plant.state_names = body_names().x;
  plant.sensors = {{"position", SensorTiming::kSampled, {false, false, false}}};
  plant.integration.step = 2 * kStep;
  PlantMode mode;
  mode.flow = std::move(flow);
  mode.outputs = {std::make_shared<const AffineMap>(Eigen::MatrixXd::Identity(3, kStates))};
  plant.modes = {mode};
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(kStates, kStates);
  KalmanCovariances covariances;
  covariances.P0 = one;
  covariances.R = {Eigen::MatrixXd(Eigen::Matrix3d::Identity() * 0.1)};
  covariances.Q = 0.05 * one;
  covariances.Q_d = 0.0 * one;
  return std::make_shared<const Law>(
      ObserverContext{std::make_shared<const Plant>(plant), Eigen::VectorXd::Constant(kStates, 0.1),
                      Eigen::VectorXd::Zero(0)},
      covariances);
}

void predict_and_correct(benchmark::State& state, const std::shared_ptr<const ObserverLaw>& law,
                         Duration duration, bool corrects) {
  Eigen::VectorXd x(law->state_size());
  Eigen::VectorXd workspace(law->workspace_size());
  law->initialize(x.data());
  const double y[] = {0.1, 0.1, 0.1};
  const Event event{1, EventKind::kSample, 0, y, 3};
  const Eigen::VectorXd first = x;
  const Allocations allocations(state);
  for (auto _ : state) {
    x = first;
    law->flow(duration, x.data(), workspace.data());
    if (corrects) law->reset(event, x.data(), workspace.data());
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

using Extended = HybridKalmanFilter;
using Unscented = UnscentedKalmanFilter;

BENCHMARK_CAPTURE(predict_and_correct, formulas_predict, filter<Extended>(body_flow()), kStep,
                  false);
BENCHMARK_CAPTURE(predict_and_correct, formulas, filter<Extended>(body_flow()), kStep, true);
BENCHMARK_CAPTURE(predict_and_correct, unscented_predict, filter<Unscented>(body_flow()), kStep,
                  false);
BENCHMARK_CAPTURE(predict_and_correct, unscented, filter<Unscented>(body_flow()), kStep, true);
BENCHMARK_CAPTURE(predict_and_correct, linear_predict, filter<Extended>(linear_flow()), kStep,
                  false);
BENCHMARK_CAPTURE(predict_and_correct, linear, filter<Extended>(linear_flow()), kStep, true);
BENCHMARK_CAPTURE(predict_and_correct, linear_uneven_time, filter<Extended>(linear_flow()), kUneven,
                  true);

}  // namespace
}  // namespace sampled_data_observers

BENCHMARK_MAIN();
