#pragma once

#include "linear_algebra/kernels/panel.h"

namespace sampled_data_observers {

// A product with an exact zero is left out: it would add a zero, which changes no sum that began
// with a positive zero, or with an entry of Q (where no zero is negative: see CovarianceFlow). It
// would also spread what is not finite to other entries; but since the diagonal of Φ is never left
// out, such an entry of P stays where it is in any case, and with it P is of no use.

/// P ← Φ P Φᵀ + Q, in which Φ P is computed transposed, as P Φᵀ: for P = Pᵀ that gives the same
/// products in the same order, and Φ is met entry by entry.
template <int kWidth>
void covariance_flow(const double* const* blocks, int digits, const SparseRows& entries,
                     std::ptrdiff_t n, double* P, double* scratch) {
  const std::ptrdiff_t stride = padded(n);
  double* padded_P = aligned<kWidth>(scratch);
  double* product = padded_P + stride * stride;
  copy_padded<kWidth>(P, n, padded_P);
  // The padding of columns becomes that of rows, and the other way round: all of it stays zero.
  for (std::ptrdiff_t i = n * stride; i < stride * stride; ++i) product[i] = 0.0;
  for (int digit = 0; digit < digits; ++digit) {
    const double* Phi = blocks[digit];
    const double* Q = Phi + entries.begin[n];
    for_each_panel<kWidth>(0, stride, [&](auto sum, std::ptrdiff_t first) {
      const double* from = padded_P + first;
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        const std::int32_t end = entries.begin[i + 1];
        std::int32_t k = entries.begin[i];
        sum.set_product(from + entries.offset[k], Phi[k]);
        for (++k; k < end; ++k) sum.add_product(from + entries.offset[k], Phi[k]);
        sum.store(product + i * stride + first);
      }
    });
    transpose_in_place<kWidth>(product, stride);
    for_each_lower_panel<kWidth>(n, [&](auto sum, std::ptrdiff_t first, std::ptrdiff_t j) {
      sum.load(Q + lower_column(n, j) + first - first_row_of_lower(j));
      for (std::int32_t k = entries.begin[j]; k < entries.begin[j + 1]; ++k) {
        sum.add_product(product + first + entries.offset[k], Phi[k]);
      }
      sum.store(padded_P + j * stride + first);
    });
    mirror_lower_of<kWidth>(padded_P, stride);
  }
  copy_unpadded<kWidth>(padded_P, n, P);
}

}  // namespace sampled_data_observers
