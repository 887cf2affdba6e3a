#pragma once

#include <cstring>

#include "linear_algebra/kernels/panel.h"

namespace sampled_data_observers {

// A product with an exact zero is left out here, too: see covariance.h.

/// What is not zero in a matrix, row after row, with the place of the row that it is multiplied by.
template <int kWidth>
class RowEntries {
 public:
  /// @param memory  row_entries_size(n) numbers
  RowEntries(double* memory, std::ptrdiff_t n)
      : values_(memory), offsets_(values_ + n * n + 1), ends_(offsets_ + n * n + 1) {}

  /// @param M  n x n, with entry (i, k) at i row + k column
  void take(const double* M, std::ptrdiff_t n, std::ptrdiff_t row, std::ptrdiff_t column) {
    const std::ptrdiff_t stride = padded(n);
    std::ptrdiff_t count = 0;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      for (std::ptrdiff_t k = 0; k < n; ++k) {
        const double value = M[i * row + k * column];
        values_[count] = value;
        write(offsets_ + count, k * stride);
        count += value != 0.0 ? 1 : 0;
      }
      write(ends_ + i, count);
    }
  }

  /// sum ← sum + Σ_k M_ik times the rows of `from`, of which one stands behind the other
  template <class Sum>
  void add_products(std::ptrdiff_t i, const double* from, Sum& sum) const {
    const std::ptrdiff_t end = read(ends_ + i);
    for (std::ptrdiff_t k = i == 0 ? 0 : read(ends_ + i - 1); k < end; ++k) {
      sum.add_product(from + read(offsets_ + k), values_[k]);
    }
  }

 private:
  // Numbers of places, in memory for doubles.
  static void write(double* to, std::ptrdiff_t number) { std::memcpy(to, &number, sizeof number); }
  static std::ptrdiff_t read(const double* from) {
    std::ptrdiff_t number = 0;
    std::memcpy(&number, from, sizeof number);
    return number;
  }
  static_assert(sizeof(std::ptrdiff_t) <= sizeof(double), "a place fits where a double does");

  double* values_;
  double* offsets_;
  double* ends_;
};

/// Φ ← I + h F + … + (h F)⁴/24, by Horner's scheme, row by row in padded rows.
/// @param scaled  padded(n)² numbers
template <int kWidth>
void transition_of_step(const RowEntries<kWidth>& F, std::ptrdiff_t n, double h, double* Phi,
                        double* scaled) {
  const std::ptrdiff_t stride = padded(n);
  for (std::ptrdiff_t i = 0; i < n * stride; ++i) Phi[i] = 0.0;
  for (std::ptrdiff_t i = 0; i < n; ++i) Phi[i * stride + i] = 1.0;
  for (int divisor = 4; divisor > 0; --divisor) {
    const double scale = h / divisor;
    for_each_panel<kWidth>(0, stride, [&](auto panel, std::ptrdiff_t first) {
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        panel.set_product(Phi + i * stride + first, scale);
        panel.store(scaled + i * stride + first);
      }
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        panel.clear();
        F.add_products(i, scaled + first, panel);
        panel.store(Phi + i * stride + first);
      }
    });
    for (std::ptrdiff_t i = 0; i < n; ++i) Phi[i * stride + i] += 1.0;
  }
}

/// As covariance_step().
template <int kWidth>
void covariance_step(const double* F, const double* Q, std::ptrdiff_t n, double h, double* P,
                     double* scratch) {
  const std::ptrdiff_t stride = padded(n);
  double* padded_P = aligned<kWidth>(scratch);
  double* Phi = padded_P + stride * stride;
  double* product = Phi + stride * stride;
  RowEntries<kWidth> entries(product + stride * stride, n);
  entries.take(F, n, 1, n);
  transition_of_step<kWidth>(entries, n, h, Phi, product);
  entries.take(Phi, n, stride, 1);

  const double half = 0.5 * h;
  for (std::ptrdiff_t i = 0; i < n * n; ++i) P[i] += half * Q[i];
  copy_padded<kWidth>(P, n, padded_P);
  for (std::ptrdiff_t i = n * stride; i < stride * stride; ++i) product[i] = 0.0;
  for_each_panel<kWidth>(0, stride, [&](auto sum, std::ptrdiff_t first) {
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      sum.clear();
      entries.add_products(i, padded_P + first, sum);
      sum.store(product + i * stride + first);
    }
  });
  transpose_in_place<kWidth>(product, stride);
  for_each_lower_panel<kWidth>(n, [&](auto sum, std::ptrdiff_t first, std::ptrdiff_t j) {
    sum.clear();
    entries.add_products(j, product + first, sum);
    sum.store(padded_P + j * stride + first);
  });
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    for (std::ptrdiff_t i = j; i < n; ++i) padded_P[j * stride + i] += half * Q[j * n + i];
  }
  mirror_lower_of<kWidth>(padded_P, stride);
  copy_unpadded<kWidth>(padded_P, n, P);
}

}  // namespace sampled_data_observers
