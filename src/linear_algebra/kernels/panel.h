#pragma once

#include <cstddef>

#include "linear_algebra/kernels.h"
#include "linear_algebra/kernels/pack.h"

namespace sampled_data_observers {

/// kRows rows of a column, in registers: a list, since compilers keep arrays in memory.
template <int kWidth, int kRows>
struct Panel {
  static constexpr int kHeight = kRows;

  void clear() {
    first = typename PackOf<kWidth>::Type{};
    rest.clear();
  }
  void load(const double* a) {
    first = SDO_STORED(kWidth, a);
    rest.load(a + kWidth);
  }
  void store(double* to) const {
    SDO_STORE(kWidth, to) = first;
    rest.store(to + kWidth);
  }
  /// ← a factor
  void set_product(const double* a, double factor) {
    first = SDO_STORED(kWidth, a) * factor;
    rest.set_product(a + kWidth, factor);
  }
  /// ← a / divisor
  void set_quotient(const double* a, double divisor) {
    first = SDO_STORED(kWidth, a) / divisor;
    rest.set_quotient(a + kWidth, divisor);
  }
  /// ← itself + a
  void add(const double* a) {
    first += SDO_STORED(kWidth, a);
    rest.add(a + kWidth);
  }
  /// ← a − itself
  void subtract_from(const double* a) {
    first = SDO_STORED(kWidth, a) - first;
    rest.subtract_from(a + kWidth);
  }
  /// ← itself + a factor
  void add_product(const double* a, double factor) {
    first += SDO_STORED(kWidth, a) * factor;
    rest.add_product(a + kWidth, factor);
  }
  /// ← itself − a factor
  void subtract_product(const double* a, double factor) {
    first -= SDO_STORED(kWidth, a) * factor;
    rest.subtract_product(a + kWidth, factor);
  }
  /// ← itself + (a − b share) factor
  void add_product_of_difference(const double* a, const double* b, double share, double factor) {
    first += (SDO_STORED(kWidth, a) - SDO_STORED(kWidth, b) * share) * factor;
    rest.add_product_of_difference(a + kWidth, b + kWidth, share, factor);
  }
  /// The register with entry kEntry.
  template <int kEntry>
  const typename PackOf<kWidth>::Type& pack_with() const {
    if constexpr (kEntry < kWidth) {
      return first;
    } else {
      return rest.template pack_with<kEntry - kWidth>();
    }
  }
  /// ← (itself, or zero) + a times one lane of a register
  template <int kLane, bool kBegins>
  void add_product_of_lane(const double* a, const typename PackOf<kWidth>::Type& pack) {
    typename PackOf<kWidth>::Type factor;
    if constexpr (kWidth == 2) {
      factor = SDO_SHUFFLE_2(pack, pack, kLane, kLane);
    } else {
      factor = SDO_SHUFFLE_4(pack, pack, kLane, kLane, kLane, kLane);
    }
    if constexpr (kBegins) {
      first = SDO_STORED(kWidth, a) * factor;
    } else {
      first += SDO_STORED(kWidth, a) * factor;
    }
    rest.template add_product_of_lane<kLane, kBegins>(a + kWidth, pack);
  }
  /// −0 becomes 0.
  void drop_negative_zeros() {
    first += 0.0;
    rest.drop_negative_zeros();
  }

  typename PackOf<kWidth>::Type first;
  Panel<kWidth, kRows - kWidth> rest;
};

template <int kWidth>
struct Panel<kWidth, 0> {
  void clear() {}
  void load(const double*) {}
  void store(double*) const {}
  void set_product(const double*, double) {}
  void set_quotient(const double*, double) {}
  void add(const double*) {}
  void subtract_from(const double*) {}
  void add_product(const double*, double) {}
  void subtract_product(const double*, double) {}
  void add_product_of_difference(const double*, const double*, double, double) {}
  template <int kLane, bool kBegins>
  void add_product_of_lane(const double*, const typename PackOf<kWidth>::Type&) {}
  void drop_negative_zeros() {}
};

/// Calls apply(panel, first) for `rows` rows, a multiple of kPadding, from `first` on, in panels of
/// kPanelRows and one with the rest.
template <int kWidth, class Apply>
void for_each_panel(std::ptrdiff_t first, std::ptrdiff_t rows, const Apply& apply) {
  for (; rows >= kPanelRows; rows -= kPanelRows, first += kPanelRows) {
    apply(Panel<kWidth, 16>(), first);
  }
  switch (rows / kPadding) {
    case 3:
      apply(Panel<kWidth, 12>(), first);
      break;
    case 2:
      apply(Panel<kWidth, 8>(), first);
      break;
    case 1:
      apply(Panel<kWidth, 4>(), first);
      break;
    default:
      break;
  }
}

/// Calls apply(panel, first, column) for all panels of the columns of a matrix of n x n, from their
/// entry on the diagonal on, or up to three before it.
template <int kWidth, class Apply>
void for_each_lower_panel(std::ptrdiff_t n, const Apply& apply) {
  for (std::ptrdiff_t top = 0; top < n; top += kPadding) {
    const std::ptrdiff_t end = top + kPadding < n ? top + kPadding : n;
    for_each_panel<kWidth>(top, padded(n) - top, [&](auto panel, std::ptrdiff_t first) {
      for (std::ptrdiff_t j = top; j < end; ++j) apply(panel, first, j);
    });
  }
}

/// The first line of the cache that begins in `scratch`.
template <int kWidth>
double* aligned(double* scratch) {
  constexpr std::uintptr_t kBytes = sizeof(double) * kLine;
  const auto place = reinterpret_cast<std::uintptr_t>(scratch);
  return scratch + (kBytes - place % kBytes) % kBytes / sizeof(double);
}

/// The less than four last entries of a column into the last four rows of a padded one; what is
/// longer than what was written in pieces would wait when it is read.
template <int kWidth>
void pad_tail(const double* tail, std::ptrdiff_t entries, double* to) {
  const double a = tail[0];
  const double b = entries > 1 ? tail[1] : 0.0;
  const double c = entries > 2 ? tail[2] : 0.0;
  if constexpr (kWidth == 2) {
    SDO_STORE(kWidth, to) = typename PackOf<kWidth>::Type{a, b};
    SDO_STORE(kWidth, to + 2) = typename PackOf<kWidth>::Type{c, 0.0};
  } else {
    SDO_STORE(kWidth, to) = typename PackOf<kWidth>::Type{a, b, c, 0.0};
  }
}

/// Copies a matrix of n x n into one with padded columns, the padding zero.
template <int kWidth>
void copy_padded(const double* M, std::ptrdiff_t n, double* to) {
  const std::ptrdiff_t stride = padded(n);
  const std::ptrdiff_t whole = n / kPadding * kPadding;
  for_each_panel<kWidth>(0, whole, [&](auto panel, std::ptrdiff_t first) {
    for (std::ptrdiff_t j = 0; j < n; ++j) {
      panel.load(M + j * n + first);
      panel.store(to + j * stride + first);
    }
  });
  for (std::ptrdiff_t j = 0; j < n && whole < n; ++j) {
    pad_tail<kWidth>(M + j * n + whole, n - whole, to + j * stride + whole);
  }
}

/// The other way round.
template <int kWidth>
void copy_unpadded(const double* M, std::ptrdiff_t n, double* to) {
  const std::ptrdiff_t stride = padded(n);
  const std::ptrdiff_t whole = n / kPadding * kPadding;
  for_each_panel<kWidth>(0, whole, [&](auto panel, std::ptrdiff_t first) {
    for (std::ptrdiff_t j = 0; j < n; ++j) {
      panel.load(M + j * stride + first);
      panel.store(to + j * n + first);
    }
  });
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    for (std::ptrdiff_t i = whole; i < n; ++i) to[j * n + i] = M[j * stride + i];
  }
}

}  // namespace sampled_data_observers
