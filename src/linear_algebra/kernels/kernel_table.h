#pragma once

#include "linear_algebra/kernels/covariance.h"
#include "linear_algebra/kernels/covariance_step.h"
#include "linear_algebra/kernels/joseph.h"
#include "linear_algebra/kernels/linear_flow.h"

namespace sampled_data_observers {

template <int kWidth>
bool are_all_within(const double* x, std::ptrdiff_t size, double limit) {
  using Pack = typename PackOf<kWidth>::Type;
  using Integers = typename PackOf<kWidth>::Integers;
  Integers within = ~Integers{};
  std::ptrdiff_t i = 0;
  for (; i + kWidth <= size; i += kWidth) {
    const Pack pack = SDO_STORED(kWidth, x + i);
    within &= (pack <= limit) & (pack >= -limit);
  }
  bool all = true;
  for (int lane = 0; lane < kWidth; ++lane) all &= within[lane] != 0;
  for (; i < size; ++i) all &= x[i] <= limit && x[i] >= -limit;
  return all;
}

/// All kernels with registers of kWidth doubles.
template <int kWidth>
struct KernelTable {
  static constexpr Kernels kTable = {
      {flow_panels<kWidth>, SmallFlow<kWidth, 1>::apply, SmallFlow<kWidth, 2>::apply,
       SmallFlow<kWidth, 3>::apply, SmallFlow<kWidth, 4>::apply, flow_one_panel<kWidth, 8>,
       flow_one_panel<kWidth, 8>, flow_one_panel<kWidth, 8>, flow_one_panel<kWidth, 8>,
       flow_one_panel<kWidth, 12>, flow_one_panel<kWidth, 12>, flow_one_panel<kWidth, 12>,
       flow_one_panel<kWidth, 12>, flow_one_panel<kWidth, 16>, flow_one_panel<kWidth, 16>,
       flow_one_panel<kWidth, 16>, flow_one_panel<kWidth, 16>},
      covariance_flow<kWidth>,
      covariance_step<kWidth>,
      update_by_joseph<kWidth>,
      are_all_within<kWidth>};
};

}  // namespace sampled_data_observers
