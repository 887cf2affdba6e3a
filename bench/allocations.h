#pragma once

#include <benchmark/benchmark.h>

#include "support/allocation_counter.h"

namespace sampled_data_observers {

/// Counts the heap allocations of a loop.
class Allocations {
 public:
  explicit Allocations(benchmark::State& state) : state_(state), before_(test::allocations()) {}
  ~Allocations() {
    const auto count = static_cast<double>(test::allocations() - before_);
    state_.counters["allocations"] =
        benchmark::Counter(count / static_cast<double>(state_.iterations()));
  }

 private:
  benchmark::State& state_;
  std::size_t before_;
};

}  // namespace sampled_data_observers
