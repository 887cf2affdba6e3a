#pragma once

#include <cstddef>
#include <cstdint>

// The products that a flow and an update consist of, for matrices whose columns are padded: with
// accumulators that stay in registers, and compiled for AVX2 beside what every processor of its
// kind can do. Which of them runs is decided at run time, and makes no difference to any bit: each
// entry of a result is summed in the order of add_product(), with one rounding per operation.
// Nothing is allocated.

namespace sampled_data_observers {

/// What the rows of a padded column are a multiple of.
constexpr std::ptrdiff_t kPadding = 4;

/// Rows of a padded column.
constexpr std::ptrdiff_t padded(std::ptrdiff_t rows) {
  return (rows + kPadding - 1) / kPadding * kPadding;
}

/// Up to so many rows are kept in registers at once.
constexpr std::ptrdiff_t kPanelRows = 16;

/// Of [Φ Γ γ], the transition of (x, u, 1): one block for each digit of a duration, its columns
/// padded.
struct FlowShape {
  std::ptrdiff_t states = 0;  ///< n
  std::ptrdiff_t inputs = 0;  ///< p
  bool has_constant = false;  ///< whether there is γ
};

/// Where entries of Φ may differ from zero, row after row. The diagonal is among them.
struct SparseRows {
  const std::int32_t* begin = nullptr;   ///< of each row, and the end: n + 1 numbers
  const std::int32_t* offset = nullptr;  ///< of each entry: padded(n) times its column
};

/// Of a symmetric matrix of n x n, the lower half is kept, column by column: column j from the
/// first of the four rows on among which its diagonal is, padded.
constexpr std::ptrdiff_t first_row_of_lower(std::ptrdiff_t j) { return j / kPadding * kPadding; }

/// Where column j of it begins; of column n, where it ends.
constexpr std::ptrdiff_t lower_column(std::ptrdiff_t n, std::ptrdiff_t j) {
  const std::ptrdiff_t top = first_row_of_lower(j);
  return top * padded(n) - top * (top - kPadding) / 2 + (j - top) * (padded(n) - top);
}

/// A measurement update: see joseph_update().
struct JosephUpdate {
  const double* rows = nullptr;
  std::ptrdiff_t outputs = 0;
  std::ptrdiff_t size = 0;
  const double* innovation = nullptr;
};

/// One compilation of the kernels.
struct Kernels {
  /// x ← Φ x + Γ u + γ with the block of each digit, in their order. `scratch`: n numbers.
  using LinearFlow = void (*)(const double* const* blocks, int digits, const FlowShape& shape,
                              const double* u, double* x, double* scratch);
  /// For n states at n, and for more than kPanelRows at 0.
  LinearFlow linear_flow[kPanelRows + 1];

  /// P ← Φ P Φᵀ + Q with the block of each digit: entries of Φ where they may differ from zero,
  /// then the lower half of Q, of n x n (lower_column()). P is n x n, symmetric to the bit, and so
  /// again. `scratch`: covariance_scratch(n) numbers.
  void (*covariance_flow)(const double* const* blocks, int digits, const SparseRows& entries,
                          std::ptrdiff_t n, double* P, double* scratch);

  /// As plant/covariance_step.h has it. `scratch`: covariance_step_scratch(n) numbers.
  void (*covariance_step)(const double* F, const double* Q, std::ptrdiff_t n, double h, double* P,
                          double* scratch);

  /// As joseph_update().
  void (*joseph_update)(const JosephUpdate& update, double* P, double* correction, double* scratch);

  /// Whether |x| <= limit holds of each entry; it does not of NaN.
  bool (*all_within)(const double* x, std::ptrdiff_t size, double limit);
};

/// So many numbers are a line of the processor's cache, at which scratch memory is made to begin.
constexpr std::ptrdiff_t kLine = 8;

/// For Kernels::covariance_flow.
constexpr std::ptrdiff_t covariance_scratch(std::ptrdiff_t n) {
  return 2 * padded(n) * padded(n) + kLine;
}

/// For Kernels::covariance_step: three padded matrices, and what is not zero in one.
constexpr std::ptrdiff_t covariance_step_scratch(std::ptrdiff_t n) {
  return 3 * padded(n) * padded(n) + 2 * (n * n + 1) + n + kLine;
}

/// For Kernels::joseph_update.
constexpr std::ptrdiff_t joseph_scratch(std::ptrdiff_t size) {
  return padded(size) * (padded(size) + 4) + kLine;
}

/// For every processor that the package is built for.
const Kernels& baseline_kernels();

/// For processors with AVX2; null where this one has none.
const Kernels* avx2_kernels();

/// The fastest that this processor can run.
const Kernels& kernels();

}  // namespace sampled_data_observers
