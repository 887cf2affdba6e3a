// What a flow, a sample, a continuous output and a jump cost for every observer type, on the small
// plants of test/types. Compare within one run: machines differ. The counter `allocations` is the
// number of heap allocations per operation.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <memory>

#include "allocations.h"
#include "support/type_examples.h"

namespace sampled_data_observers {
namespace {

constexpr Duration kStep = 12'345'678;  // an arbitrary flow of about 12 ms

/// A law in the state after one event of each channel.
class PreparedLaw {
 public:
  explicit PreparedLaw(const std::string& example)
      : law_(test::read_example(example).law),
        state_(law_->state_size()),
        workspace_(law_->workspace_size()) {
    law_->initialize(state_.data());
    for (const EventKind kind : {EventKind::kInput, EventKind::kOutput, EventKind::kSample}) {
      for (int sensor = 0; sensor < 4; ++sensor) {
        const Event event = this->event(kind, sensor);
        if (event.size >= 0) reset(event);
      }
    }
    law_->flow(kNanosecondsPerSecond, state_.data(), workspace_.data());
    prepared_ = state_;
  }

  /// The event of a sensor with most values; of size -1 where there is none.
  Event event(EventKind kind, int sensor) {
    values_.setConstant(law_->max_event_size(), 0.2);
    const PlantObserver& observer = law_->observer();
    Event result{1, kind, sensor, values_.data(),
                 observer.event_size(kind, static_cast<std::size_t>(sensor))};
    if (kind == EventKind::kJump && observer.plant().switches()) result.mode = 2.0;
    return result;
  }

  const ObserverLaw& law() const { return *law_; }
  void restore() { state_ = prepared_; }
  void flow() { law_->flow(kStep, state_.data(), workspace_.data()); }
  void reset(const Event& event) { law_->reset(event, state_.data(), workspace_.data()); }

 private:
  std::shared_ptr<const ObserverLaw> law_;
  Eigen::VectorXd state_;
  Eigen::VectorXd workspace_;
  Eigen::VectorXd prepared_;
  Eigen::VectorXd values_;
};

// Every operation starts from the same state: the copy of it is part of the time.

void flow(benchmark::State& state, const std::string& example) {
  PreparedLaw law(example);
  const Allocations allocations(state);
  for (auto _ : state) {
    law.restore();
    law.flow();
    benchmark::ClobberMemory();
  }
}

void reset(benchmark::State& state, const std::string& example, EventKind kind, int sensor) {
  PreparedLaw law(example);
  const Event event = law.event(kind, sensor);
  const Allocations allocations(state);
  for (auto _ : state) {
    law.restore();
    law.reset(event);
    benchmark::ClobberMemory();
  }
}

/// The last sensor of which the law has events of a kind; -1 where there is none.
int last_sensor(const ObserverLaw& law, EventKind kind) {
  if (kind == EventKind::kJump) return law.observer().plant().jumps() ? 0 : -1;
  int sensor = 3;
  while (sensor >= 0 && law.observer().event_size(kind, static_cast<std::size_t>(sensor)) < 0) {
    --sensor;
  }
  return sensor;
}

void register_type(const std::string& example) {
  benchmark::RegisterBenchmark((example + "/flow").c_str(),
                               [example](benchmark::State& state) { flow(state, example); });
  const PreparedLaw law(example);
  const auto register_reset = [&](EventKind kind, const char* name) {
    const int sensor = last_sensor(law.law(), kind);
    if (sensor < 0) return;
    benchmark::RegisterBenchmark((example + "/" + name).c_str(), [=](benchmark::State& state) {
      reset(state, example, kind, sensor);
    });
  };
  register_reset(EventKind::kSample, "sample");
  register_reset(EventKind::kOutput, "output");
  register_reset(EventKind::kJumpOutput, "jump_output");
  register_reset(EventKind::kJump, "jump");
}

}  // namespace
}  // namespace sampled_data_observers

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const std::string& example : sampled_data_observers::test::type_examples()) {
    sampled_data_observers::register_type(example);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
