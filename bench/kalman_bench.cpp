// What a prediction over 10 ms and a correction by three outputs cost with 15 states, beside
// robot_localization's extended Kalman filter in the same run where its sources are given; what an
// event costs that a gate rejects; and how long the tables of a flow take. Compare within one run:
// machines differ. The counter `allocations` is the number of heap allocations per operation.
#include <benchmark/benchmark.h>
#include <malloc.h>
#include <unistd.h>

#include <Eigen/Core>
#include <fstream>
#include <memory>
#include <string>

#include "allocations.h"
#include "body_plant.h"
#include "observer/constant_gain_observer.h"
#include "observer/gated_measurements.h"
#include "observer/hybrid_kalman_filter.h"
#include "plant/linear_plant.h"
#include "sampled_data_observers/hybrid/timeline.h"
#ifdef SDO_ROBOT_LOCALIZATION
#include "ekf.cpp"
#include "filter_base.cpp"
#include "filter_utilities.cpp"
#endif

namespace sampled_data_observers {
namespace {

constexpr Stamp kStart = 1'600'000'000'000'000'000;
constexpr Duration kStep = 10'000'000;

/// The states of robot_localization: position, roll, pitch and yaw, their rates, and the
/// acceleration; measured is the position.
ObserverContext pose() {
  LinearPlantDescription plant;
  for (int i = 0; i < 15; ++i) plant.state_names.push_back("x" + std::to_string(i));
  plant.A = Eigen::MatrixXd::Zero(15, 15);
  plant.A.block(0, 6, 6, 6).setIdentity();
  plant.A.block(6, 12, 3, 3).setIdentity();
  plant.B = Eigen::MatrixXd::Zero(15, 0);
  plant.sensors = {{"position", Eigen::MatrixXd::Identity(3, 15), {false, false, false}}};
  return {make_linear_plant(plant), Eigen::VectorXd::Zero(15), Eigen::VectorXd::Zero(0)};
}

/// A flow of 10 ms and a sample after it, over and over.
void cycle(benchmark::State& state, const ObserverLaw& law) {
  Eigen::VectorXd x(law.state_size());
  Eigen::VectorXd workspace(law.workspace_size());
  Eigen::VectorXd y = Eigen::VectorXd::Ones(law.max_event_size());
  law.initialize(x.data());
  const Event event{kStart, EventKind::kSample, 0, y.data(), y.size()};
  const Allocations allocations(state);
  for (auto _ : state) {
    law.flow(kStep, x.data(), workspace.data());
    law.reset(event, x.data(), workspace.data());
    y = -y;  // so that nothing sinks to denormal numbers
    benchmark::ClobberMemory();
  }
}

void KalmanCycle(benchmark::State& state) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(15, 15);
  cycle(state,
        HybridKalmanFilter(pose(), {one, {0.01 * Eigen::Matrix3d::Identity()}, 0.01 * one, one}));
}

/// The plant of robot_localization's filter, by formulas, integrated in one step as there.
ObserverContext body() {
  PlantDescription plant;
  plant.state_names = body_names().x;
  plant.sensors = {{"position", SensorTiming::kSampled, {false, false, false}}};
  plant.integration.step = kStep;
  PlantMode mode;
  mode.flow = body_flow();
  mode.outputs = {std::make_shared<const AffineMap>(Eigen::MatrixXd::Identity(3, 15))};
  plant.modes = {mode};
  return {std::make_shared<const Plant>(plant), Eigen::VectorXd::Zero(15),
          Eigen::VectorXd::Zero(0)};
}

void KalmanCycleByFormulas(benchmark::State& state) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(15, 15);
  cycle(state, HybridKalmanFilter(body(), {one,
                                           {0.01 * Eigen::Matrix3d::Identity()},
                                           0.01 * one,
                                           Eigen::MatrixXd::Zero(15, 15)}));
}

void FixedGainCycle(benchmark::State& state) {
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(15, 3);
  L.topRows(3).diagonal().setConstant(0.3);
  L.middleRows(6, 3).diagonal().setConstant(0.5);
  L.bottomRows(3).diagonal().setConstant(0.2);
  cycle(state, ConstantGainObserver(pose(), {L}));
}

#ifdef SDO_ROBOT_LOCALIZATION
void RobotLocalizationCycle(benchmark::State& state) {
  RobotLocalization::Ekf filter;
  filter.setProcessNoiseCovariance(0.01 * Eigen::MatrixXd::Identity(15, 15));
  RobotLocalization::Measurement measurement;
  measurement.topicName_ = "position";
  measurement.updateVector_ = std::vector<int>(15, 0);
  for (std::size_t i = 0; i < 3; ++i) measurement.updateVector_[i] = 1;
  measurement.measurement_ = Eigen::VectorXd::Ones(15);
  measurement.covariance_ = 0.01 * Eigen::MatrixXd::Identity(15, 15);
  filter.processMeasurement(measurement);  // the first one initializes
  const Allocations allocations(state);
  for (auto _ : state) {
    filter.predict(0.0, to_seconds(kStep));
    filter.correct(measurement);
    measurement.measurement_ = -measurement.measurement_;
    benchmark::ClobberMemory();
  }
}
BENCHMARK(RobotLocalizationCycle);
#endif

/// Takes in a sample that its gate rejects, as it did all before, of which state.range(0) are kept.
void GatedEvent(benchmark::State& state) {
  LinearPlantDescription plant;
  plant.state_names = {"x"};
  plant.A = Eigen::MatrixXd::Zero(1, 1);
  plant.B = Eigen::MatrixXd::Zero(1, 0);
  plant.sensors = {{"s", Eigen::MatrixXd::Identity(1, 1), {false}}};
  const ObserverContext context = {make_linear_plant(plant), Eigen::VectorXd::Zero(1),
                                   Eigen::VectorXd::Zero(0)};
  Gate gate;
  gate.innovation = Eigen::VectorXd::Ones(1);
  gate.recover_after = 1'000'000 * kNanosecondsPerSecond;
  const auto law = std::make_shared<const GatedMeasurements>(
      std::make_shared<const ConstantGainObserver>(
          context, std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Ones(1, 1)}),
      std::vector<std::optional<Gate>>{gate});
  const auto kept = static_cast<std::size_t>(state.range(0));
  Timeline timeline(law, {1'000'000 * kNanosecondsPerSecond, kept});
  const double y = 5.0;
  Stamp stamp = kStart;
  const auto insert = [&] {
    stamp += 1000;
    return timeline.insert({stamp, EventKind::kSample, 0, &y, 1});
  };
  for (std::size_t i = 0; i < kept; ++i) insert();
  const Allocations allocations(state);
  for (auto _ : state) benchmark::DoNotOptimize(insert().previous);
}

/// Resident memory of this process [MB].
double resident() {
  long pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;
  return static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// Makes a Kalman filter of n states, all of which move all others. The counter `MB` is the memory
/// that the process has more of with it.
void KalmanStart(benchmark::State& state) {
  const Eigen::Index n = state.range(0);
  std::srand(1);
  LinearPlantDescription plant;
  plant.state_names.resize(static_cast<std::size_t>(n), "x");
  plant.A = Eigen::MatrixXd::Random(n, n) - 2.0 * Eigen::MatrixXd::Identity(n, n);
  plant.B = Eigen::MatrixXd::Zero(n, 0);
  plant.sensors = {{"s", Eigen::MatrixXd::Identity(1, n), {false}}};
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  const ObserverContext context = {make_linear_plant(plant), Eigen::VectorXd::Zero(n),
                                   Eigen::VectorXd::Zero(0)};
  ::malloc_trim(0);  // what earlier ones have left is none of it
  const double before = resident();
  double with = before;
  for (auto _ : state) {
    const HybridKalmanFilter filter(context, {one, {Eigen::MatrixXd::Identity(1, 1)}, one, one});
    benchmark::DoNotOptimize(&filter);
    if (with == before) with = resident();
  }
  state.counters["MB"] = with - before;
}

BENCHMARK(KalmanCycle);
BENCHMARK(KalmanCycleByFormulas);
BENCHMARK(FixedGainCycle);
BENCHMARK(GatedEvent)->Arg(100)->Arg(2000)->Arg(20000)->Arg(200000);
BENCHMARK(KalmanStart)->Arg(4)->Arg(15)->Arg(50)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sampled_data_observers

BENCHMARK_MAIN();
