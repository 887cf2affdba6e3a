#pragma once

#include "linear_algebra/kernels/panel.h"

namespace sampled_data_observers {

// The first product of a sum is not added to zero, as it is in add_product(). All that this changes
// is that a zero may be negative; a zero changes nothing but zeros, and at the end all are made
// positive, which they always are in a sum that begins with zero.

/// For kStates <= 4: between digits, x stays in registers.
template <int kWidth, int kStates>
struct SmallFlow {
  static constexpr int kRows = 4;
  static constexpr int kUsed = (kStates + kWidth - 1) / kWidth * kWidth;
  using Column = Panel<kWidth, kUsed>;

  /// next ← next + column kEntry of a block times that entry of x
  template <int kEntry>
  static void add_column(const double* block, const Column& x, Column& next) {
    if constexpr (kEntry < kStates) {
      next.template add_product_of_lane<kEntry % kWidth, kEntry == 0>(
          block + kEntry * kRows, x.template pack_with<kEntry>());
    }
  }
  static void add_inputs(const double* column, const FlowShape& shape, const double* u,
                         Column& next) {
    for (std::ptrdiff_t j = 0; j < shape.inputs; ++j, column += kRows) {
      next.add_product(column, u[j]);
    }
    if (shape.has_constant) next.add(column);
  }

  static void apply(const double* const* blocks, int digits, const FlowShape& shape,
                    const double* u, double* x, double* /*scratch*/) {
    Column now;
    // Entry by entry: what wrote them may have done so one by one, and a longer load would wait.
    now.set_product(blocks[0], x[0]);
    for (int j = 1; j < kStates; ++j) now.add_product(blocks[0] + j * kRows, x[j]);
    add_inputs(blocks[0] + kStates * kRows, shape, u, now);
    for (int digit = 1; digit < digits; ++digit) {
      const double* block = blocks[digit];
      Column next;
      add_column<0>(block, now, next);
      add_column<1>(block, now, next);
      add_column<2>(block, now, next);
      add_column<3>(block, now, next);
      add_inputs(block + kStates * kRows, shape, u, next);
      now = next;
    }
    now.drop_negative_zeros();
    if constexpr (kStates == kUsed) {
      now.store(x);
    } else {
      alignas(32) double at[kUsed];
      now.store(at);
      for (int i = 0; i < kStates; ++i) x[i] = at[i];
    }
  }
};

/// For as many states as fill one panel.
template <int kWidth, int kRows>
void flow_one_panel(const double* const* blocks, int digits, const FlowShape& shape,
                    const double* u, double* x, double* /*scratch*/) {
  alignas(32) double at[kRows];
  const double* from = x;
  Panel<kWidth, kRows> next;
  int digit = 0;
  do {
    const double* column = blocks[digit];
    next.set_product(column, from[0]);
    column += kRows;
    for (std::ptrdiff_t j = 1; j < shape.states; ++j, column += kRows) {
      next.add_product(column, from[j]);
    }
    for (std::ptrdiff_t j = 0; j < shape.inputs; ++j, column += kRows) {
      next.add_product(column, u[j]);
    }
    if (shape.has_constant) next.add(column);
    next.store(at);
    from = at;
  } while (++digit < digits);
  next.drop_negative_zeros();
  next.store(at);
  std::ptrdiff_t i = 0;
  for (; i + kWidth <= shape.states; i += kWidth)
    SDO_STORE(kWidth, x + i) = SDO_STORED(kWidth, at + i);
  for (; i < shape.states; ++i) x[i] = at[i];
}

/// For any number of states.
template <int kWidth>
void flow_panels(const double* const* blocks, int digits, const FlowShape& shape, const double* u,
                 double* x, double* scratch) {
  const std::ptrdiff_t n = shape.states;
  const std::ptrdiff_t stride = padded(n);
  for (int digit = 0; digit < digits; ++digit) {
    for_each_panel<kWidth>(0, stride, [&](auto next, std::ptrdiff_t first) {
      constexpr std::ptrdiff_t kRows = decltype(next)::kHeight;
      alignas(32) double part[kRows];
      const double* column = blocks[digit] + first;
      next.clear();
      for (std::ptrdiff_t j = 0; j < n; ++j, column += stride) next.add_product(column, x[j]);
      for (std::ptrdiff_t j = 0; j < shape.inputs; ++j, column += stride) {
        next.add_product(column, u[j]);
      }
      if (shape.has_constant) next.add(column);
      next.store(part);
      for (std::ptrdiff_t i = 0; i < kRows && first + i < n; ++i) scratch[first + i] = part[i];
    });
    for (std::ptrdiff_t i = 0; i < n; ++i) x[i] = scratch[i];
  }
}

}  // namespace sampled_data_observers
