#pragma once

#include "linear_algebra/kernels/panel.h"

namespace sampled_data_observers {

/// The part of a row outside which it is zero.
struct UsedPart {
  std::ptrdiff_t begin;
  std::ptrdiff_t end;
};

template <int kWidth>
UsedPart used_part(const double* c, std::ptrdiff_t size) {
  UsedPart part = {0, size};
  while (part.end > 0 && c[part.end - 1] == 0.0) --part.end;
  while (part.begin < part.end && c[part.begin] == 0.0) ++part.begin;
  return part;
}

/// a · b over a part
template <int kWidth>
double dot_of_part(const double* a, const double* b, const UsedPart& part) {
  double sum = 0.0;
  for (std::ptrdiff_t i = part.begin; i < part.end; ++i) sum += a[i] * b[i];
  return sum;
}

/// As joseph_update(). Of P only the lower triangle is kept up to date, and what an output reads of
/// the upper one.
template <int kWidth>
void update_by_joseph(const JosephUpdate& update, double* P, double* correction, double* scratch) {
  const std::ptrdiff_t size = update.size;
  const std::ptrdiff_t stride = padded(size);
  double* M = aligned<kWidth>(scratch);
  double* column = M + stride * stride;  // P c
  double* gain = column + stride;
  double* change = gain + stride;  // K − (I − K c) P c
  double* total = change + stride;
  copy_padded<kWidth>(P, size, M);
  for (std::ptrdiff_t i = 0; i < stride; ++i) total[i] = 0.0;
  for (std::ptrdiff_t output = 0; output < update.outputs; ++output) {
    const double* c = update.rows + output * size;
    const UsedPart used = used_part<kWidth>(c, size);
    for (std::ptrdiff_t k = used.begin; output > 0 && k < used.end; ++k) {
      for (std::ptrdiff_t i = 0; i < k; ++i) M[k * stride + i] = M[i * stride + k];
    }
    for_each_panel<kWidth>(0, stride, [&](auto sum, std::ptrdiff_t first) {
      sum.clear();
      for (std::ptrdiff_t k = used.begin; k < used.end; ++k) {
        sum.add_product(M + k * stride + first, c[k]);
      }
      sum.store(column + first);
    });
    const double share = dot_of_part<kWidth>(c, column, used);
    // Rounding may leave c P cᵀ a little below zero.
    const double variance = 1.0 + (0.0 < share ? share : 0.0);
    const double left = update.innovation[output] - dot_of_part<kWidth>(c, total, used);
    for_each_panel<kWidth>(0, stride, [&](auto panel, std::ptrdiff_t first) {
      panel.set_quotient(column + first, variance);
      panel.store(gain + first);
      panel.load(total + first);
      panel.add_product(gain + first, left);
      panel.store(total + first);
      panel.clear();
      for (std::ptrdiff_t k = used.begin; k < used.end; ++k) {
        panel.add_product_of_difference(M + k * stride + first, gain + first, column[k], c[k]);
      }
      panel.subtract_from(gain + first);
      panel.store(change + first);
    });
    for_each_lower_panel<kWidth>(size, [&](auto panel, std::ptrdiff_t first, std::ptrdiff_t j) {
      panel.load(M + j * stride + first);
      panel.subtract_product(gain + first, column[j]);
      panel.add_product(change + first, gain[j]);
      panel.store(M + j * stride + first);
    });
  }
  mirror_lower_of<kWidth>(M, stride);
  copy_unpadded<kWidth>(M, size, P);
  for (std::ptrdiff_t i = 0; i < size; ++i) correction[i] = total[i];
}

}  // namespace sampled_data_observers
