// What one flow, one sample and one rewind cost, beside the bare product of the same size and
// Eigen's matrix exponential, for n states and one output. Compare within one run: machines differ.
// The counter `allocations` is the number of heap allocations per operation.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <memory>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>

#include "allocations.h"
#include "observer/constant_gain_observer.h"
#include "plant/linear_plant.h"
#include "sampled_data_observers/hybrid/timeline.h"
#include "sampled_data_observers/plant/expression_map.h"

namespace sampled_data_observers {
namespace {

constexpr Stamp kStart = 1'600'000'000'000'000'000;
constexpr Duration kStep = 12'345'678;  // an arbitrary step of about 12 ms

/// Oscillating, so that a state flows for ever without growing or sinking to denormal numbers.
Eigen::MatrixXd example_A(Eigen::Index n) {
  std::srand(1);
  const Eigen::MatrixXd M = Eigen::MatrixXd::Random(n, n);
  return M - M.transpose();
}

std::shared_ptr<const ConstantGainObserver> example_law(Eigen::Index n) {
  LinearPlantDescription plant;
  plant.state_names.resize(static_cast<std::size_t>(n), "x");
  plant.A = example_A(n);
  plant.B = Eigen::MatrixXd::Zero(n, 0);
  plant.sensors = {{"s", Eigen::MatrixXd::Identity(1, n), {false}}};
  return std::make_shared<const ConstantGainObserver>(
      ObserverContext{make_linear_plant(plant), Eigen::VectorXd::Ones(n), Eigen::VectorXd::Zero(0)},
      std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Constant(n, 1, 0.1)});
}

void BareFlow(benchmark::State& state) {
  const Eigen::Index n = state.range(0);
  const Eigen::MatrixXd Phi = (example_A(n) * to_seconds(kStep)).exp();
  Eigen::VectorXd x = Eigen::VectorXd::Ones(n);
  Eigen::VectorXd next(n);
  const Allocations allocations(state);
  for (auto _ : state) {
    next.noalias() = Phi * x;
    benchmark::DoNotOptimize(next.data());
    benchmark::ClobberMemory();
  }
}

void EigenExponentialFlow(benchmark::State& state) {
  const Eigen::Index n = state.range(0);
  const Eigen::MatrixXd A = example_A(n);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(n);
  Eigen::VectorXd next(n);
  const Allocations allocations(state);
  for (auto _ : state) {
    next.noalias() = (A * to_seconds(kStep)).exp() * x;
    benchmark::DoNotOptimize(next.data());
    benchmark::ClobberMemory();
  }
}

void Flow(benchmark::State& state) {
  const auto law = example_law(state.range(0));
  Eigen::VectorXd x(law->state_size());
  Eigen::VectorXd workspace(law->workspace_size());
  law->initialize(x.data());
  const Allocations allocations(state);
  for (auto _ : state) {
    law->flow(kStep, x.data(), workspace.data());
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

void BareSample(benchmark::State& state) {
  const Eigen::Index n = state.range(0);
  const Eigen::MatrixXd C = Eigen::MatrixXd::Identity(1, n);
  const Eigen::MatrixXd L = Eigen::MatrixXd::Constant(n, 1, 0.1);
  const Eigen::VectorXd y = Eigen::VectorXd::Ones(1);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(n);
  Eigen::VectorXd innovation(1);
  const Allocations allocations(state);
  for (auto _ : state) {
    innovation = y - C.lazyProduct(x);
    x += L.lazyProduct(innovation);
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

void Sample(benchmark::State& state) {
  const auto law = example_law(state.range(0));
  Eigen::VectorXd x(law->state_size());
  Eigen::VectorXd workspace(law->workspace_size());
  law->initialize(x.data());
  const double y = 1.0;
  const Event event{kStart, EventKind::kSample, 0, &y, 1};
  const Allocations allocations(state);
  for (auto _ : state) {
    law->reset(event, x.data(), workspace.data());
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

/// The two together, over 10 ms.
void BareFlowAndSample(benchmark::State& state) {
  const Eigen::Index n = state.range(0);
  const Eigen::MatrixXd Phi = (example_A(n) * 0.01).exp();
  const Eigen::MatrixXd C = Eigen::MatrixXd::Identity(1, n);
  const Eigen::MatrixXd L = Eigen::MatrixXd::Constant(n, 1, 0.1);
  const Eigen::VectorXd y = Eigen::VectorXd::Ones(1);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(n);
  Eigen::VectorXd next(n);
  Eigen::VectorXd innovation(1);
  const Allocations allocations(state);
  for (auto _ : state) {
    next.noalias() = Phi * x;
    innovation = y - C.lazyProduct(next);
    x = next + L.lazyProduct(innovation);
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

void FlowAndSample(benchmark::State& state) {
  const auto law = example_law(state.range(0));
  Eigen::VectorXd x(law->state_size());
  Eigen::VectorXd workspace(law->workspace_size());
  law->initialize(x.data());
  const double y = 1.0;
  const Event event{kStart, EventKind::kSample, 0, &y, 1};
  const Allocations allocations(state);
  for (auto _ : state) {
    law->flow(10'000'000, x.data(), workspace.data());
    law->reset(event, x.data(), workspace.data());
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

/// 10 ms and a sample, by turns of each of `state.range(0)` sensors of six states.
void FlowAndSampleInTurn(benchmark::State& state) {
  constexpr Eigen::Index kStates = 6;
  LinearPlantDescription plant;
  plant.state_names.resize(kStates, "x");
  plant.A = example_A(kStates);
  plant.B = Eigen::MatrixXd::Zero(kStates, 0);
  const int sensors = static_cast<int>(state.range(0));
  for (int i = 0; i < sensors; ++i) {
    plant.sensors.push_back(
        {"s" + std::to_string(i), Eigen::MatrixXd::Identity(1, kStates), {false}});
  }
  const ConstantGainObserver law(
      {make_linear_plant(plant), Eigen::VectorXd::Ones(kStates), Eigen::VectorXd::Zero(0)},
      std::vector<Eigen::MatrixXd>(plant.sensors.size(),
                                   Eigen::MatrixXd::Constant(kStates, 1, 0.1)));
  Eigen::VectorXd x(law.state_size());
  Eigen::VectorXd workspace(law.workspace_size());
  law.initialize(x.data());
  const double y = 1.0;
  Event event{kStart, EventKind::kSample, 0, &y, 1};
  const Allocations allocations(state);
  for (auto _ : state) {
    law.flow(10'000'000, x.data(), workspace.data());
    law.reset(event, x.data(), workspace.data());
    event.sensor = (event.sensor + 1) % sensors;
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

/// Takes in one event with `state.range(1)` later ones behind it, then a new one at the end.
void Rewind(benchmark::State& state) {
  const auto law = example_law(state.range(0));
  const std::int64_t later = state.range(1);
  Timeline timeline(law, {1000 * kNanosecondsPerSecond, 300});
  const double y = 1.0;
  Stamp stamp = kStart;
  const auto insert = [&](Stamp at) {
    return timeline.insert({at, EventKind::kSample, 0, &y, 1}).rewound;
  };
  for (int i = 0; i < 400; ++i) insert(stamp += kStep);
  const Allocations allocations(state);
  for (auto _ : state) {
    insert(stamp += kStep);
    // Half of the events behind it were late ones of earlier rounds.
    benchmark::DoNotOptimize(insert(stamp - (later / 2) * kStep - (later % 2) * kStep / 2 - 1));
  }
}

/// Takes in the newest sample, whose stamp `state.range(0)` samples share, for n = 4.
void SharedStamp(benchmark::State& state) {
  const auto law = example_law(4);
  Timeline timeline(law, {1000 * kNanosecondsPerSecond, 2000});
  Stamp stamp = kStart;
  std::int64_t of_stamp = 0;
  const auto insert = [&] {
    if (++of_stamp > state.range(0)) {
      of_stamp = 1;
      stamp += kStep;
    }
    const auto y = static_cast<double>(of_stamp);
    benchmark::DoNotOptimize(timeline.insert({stamp, EventKind::kSample, 0, &y, 1}).previous);
  };
  for (int i = 0; i < 4000; ++i) insert();
  const Allocations allocations(state);
  for (auto _ : state) insert();
}

/// ẋ_i = −x_i/10 + 0.3 sin x_{i+1} + 0.2 x_{i+2} cos x_{i+3}
std::shared_ptr<const ConstantGainObserver> law_by_formulas(Eigen::Index n) {
  PlantDescription plant;
  std::vector<NamedExpression> formulas;
  for (Eigen::Index i = 0; i < n; ++i) plant.state_names.push_back("x" + std::to_string(i));
  const auto name = [&](Eigen::Index i) { return "x" + std::to_string(i % n); };
  for (Eigen::Index i = 0; i < n; ++i) {
    formulas.push_back({name(i), "-0.1*" + name(i) + " + 0.3*sin(" + name(i + 1) + ") + 0.2*" +
                                     name(i + 2) + "*cos(" + name(i + 3) + ")"});
  }
  plant.sensors = {{"s", SensorTiming::kSampled, {false}}};
  PlantMode mode;
  mode.flow = std::make_shared<const ExpressionMap>(ExpressionNames{plant.state_names, {}, {}},
                                                    std::vector<NamedExpression>{}, formulas);
  mode.outputs = {std::make_shared<const AffineMap>(Eigen::MatrixXd::Identity(1, n))};
  plant.modes = {mode};
  plant.integration.horizon = 1000000 * plant.integration.step;
  return std::make_shared<const ConstantGainObserver>(
      ObserverContext{std::make_shared<const Plant>(plant), Eigen::VectorXd::Ones(n),
                      Eigen::VectorXd::Zero(0)},
      std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Constant(n, 1, 0.1)});
}

/// As many steps of an integration as a live observer does at a time (SharedRuntime::kSteps).
void EightSteps(benchmark::State& state) {
  const auto law = law_by_formulas(state.range(0));
  Timeline timeline(law, {kNanosecondsPerSecond, 10});
  const double value = 1.0;
  timeline.insert({kStart, EventKind::kSample, 0, &value, 1});
  const Stamp end = kStart + law->flow_horizon();
  const Allocations allocations(state);
  for (auto _ : state) {
    if (timeline.approach(end, 8) > 0) continue;
    timeline.approach(kStart + law->flow_step(), 8);  // begins anew
  }
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  for (const int n : {2, 4, 6, 15}) benchmark->Arg(n);
}

void SizesAndDepths(benchmark::internal::Benchmark* benchmark) {
  for (const int n : {2, 4, 6, 15}) {
    for (const int k : {0, 1, 10, 100}) benchmark->Args({n, k});
  }
}

BENCHMARK(BareFlow)->Apply(Sizes);
BENCHMARK(Flow)->Apply(Sizes);
BENCHMARK(EigenExponentialFlow)->Apply(Sizes);
BENCHMARK(BareSample)->Apply(Sizes);
BENCHMARK(Sample)->Apply(Sizes);
BENCHMARK(BareFlowAndSample)->Apply(Sizes);
BENCHMARK(FlowAndSample)->Apply(Sizes);
BENCHMARK(FlowAndSampleInTurn)->Arg(1)->Arg(4)->Arg(16)->Arg(64);
BENCHMARK(Rewind)->Apply(SizesAndDepths);
BENCHMARK(SharedStamp)->Arg(1)->Arg(10)->Arg(100)->Arg(1000);
BENCHMARK(EightSteps)->Apply(Sizes);

}  // namespace
}  // namespace sampled_data_observers

BENCHMARK_MAIN();
