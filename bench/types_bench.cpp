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
      for (int channel = 0; channel < 4; ++channel) {
        if (law_->event_size(kind, channel) >= 0) reset(event(kind, channel));
      }
    }
    law_->flow(kNanosecondsPerSecond, state_.data(), workspace_.data());
    prepared_ = state_;
  }

  /// The event of a channel with most values.
  Event event(EventKind kind, int channel) {
    values_.setConstant(law_->max_event_size(), 0.2);
    Event result{1, kind, channel, values_.data(), law_->event_size(kind, channel), 0};
    if (kind == EventKind::kJump && !law_->observer().knows_mode(result)) values_(0) = 2.0;
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

void reset(benchmark::State& state, const std::string& example, EventKind kind, int channel) {
  PreparedLaw law(example);
  const Event event = law.event(kind, channel);
  const Allocations allocations(state);
  for (auto _ : state) {
    law.restore();
    law.reset(event);
    benchmark::ClobberMemory();
  }
}

/// The last channel of a kind that the law has, which has most values; -1 where there is none.
int last_channel(const ObserverLaw& law, EventKind kind) {
  int channel = 3;
  while (channel >= 0 && law.event_size(kind, channel) < 0) --channel;
  return channel;
}

void register_type(const std::string& example) {
  benchmark::RegisterBenchmark((example + "/flow").c_str(),
                               [example](benchmark::State& state) { flow(state, example); });
  const PreparedLaw law(example);
  const auto register_reset = [&](EventKind kind, const char* name) {
    const int channel = last_channel(law.law(), kind);
    if (channel < 0) return;
    benchmark::RegisterBenchmark((example + "/" + name).c_str(), [=](benchmark::State& state) {
      reset(state, example, kind, channel);
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
