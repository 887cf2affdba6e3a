#pragma once

#include <cstddef>

namespace sampled_data_observers {

// Vectors of the compiler's: gcc and clang make of them what the processor has. All functions are
// templates of the width: a file compiled for AVX2 must leave none behind that the linker could
// take for one of another file. None has a vector as an argument or result: how those are passed
// depends on what the processor has.

/// kWidth doubles in one register.
template <int kWidth>
struct PackOf;

template <>
struct PackOf<2> {
  using Type = double __attribute__((vector_size(16)));
  using Integers = long long __attribute__((vector_size(16)));
  /// The same in memory, wherever a double may be.
  struct __attribute__((packed, aligned(8))) Stored {
    Type pack;
  };
};

template <>
struct PackOf<4> {
  using Type = double __attribute__((vector_size(32)));
  using Integers = long long __attribute__((vector_size(32)));
  /// The same in memory, wherever a double may be.
  struct __attribute__((packed, aligned(8))) Stored {
    Type pack;
  };
};

#define SDO_STORED(kWidth, place) \
  (reinterpret_cast<const typename PackOf<kWidth>::Stored*>(place)->pack)
#define SDO_STORE(kWidth, place) (reinterpret_cast<typename PackOf<kWidth>::Stored*>(place)->pack)

#if defined(__clang__)
#define SDO_SHUFFLE_2(a, b, i, j) __builtin_shufflevector(a, b, i, j)
#define SDO_SHUFFLE_4(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define SDO_SHUFFLE_2(a, b, i, j) __builtin_shuffle(a, b, PackOf<2>::Integers{i, j})
#define SDO_SHUFFLE_4(a, b, i, j, k, l) __builtin_shuffle(a, b, PackOf<4>::Integers{i, j, k, l})
#endif

/// kWidth x kWidth numbers, column by column, in registers.
template <int kWidth>
struct Tile;

template <>
struct Tile<2> {
  template <int kWidth = 2>
  void load(const double* from, std::ptrdiff_t stride) {
    a = SDO_STORED(kWidth, from);
    b = SDO_STORED(kWidth, from + stride);
  }
  template <int kWidth = 2>
  void store(double* to, std::ptrdiff_t stride) const {
    SDO_STORE(kWidth, to) = a;
    SDO_STORE(kWidth, to + stride) = b;
  }
  template <int kWidth = 2>
  void transpose() {
    const typename PackOf<kWidth>::Type first = SDO_SHUFFLE_2(a, b, 0, 2);
    b = SDO_SHUFFLE_2(a, b, 1, 3);
    a = first;
  }
  /// The lower triangle onto the upper one.
  template <int kWidth = 2>
  void mirror() {
    b = SDO_SHUFFLE_2(a, b, 1, 3);
  }

  PackOf<2>::Type a;
  PackOf<2>::Type b;
};

template <>
struct Tile<4> {
  template <int kWidth = 4>
  void load(const double* from, std::ptrdiff_t stride) {
    a = SDO_STORED(kWidth, from);
    b = SDO_STORED(kWidth, from + stride);
    c = SDO_STORED(kWidth, from + 2 * stride);
    d = SDO_STORED(kWidth, from + 3 * stride);
  }
  template <int kWidth = 4>
  void store(double* to, std::ptrdiff_t stride) const {
    SDO_STORE(kWidth, to) = a;
    SDO_STORE(kWidth, to + stride) = b;
    SDO_STORE(kWidth, to + 2 * stride) = c;
    SDO_STORE(kWidth, to + 3 * stride) = d;
  }
  template <int kWidth = 4>
  void transpose() {
    using Pack = typename PackOf<kWidth>::Type;
    const Pack even_ab = SDO_SHUFFLE_4(a, b, 0, 4, 2, 6);
    const Pack odd_ab = SDO_SHUFFLE_4(a, b, 1, 5, 3, 7);
    const Pack even_cd = SDO_SHUFFLE_4(c, d, 0, 4, 2, 6);
    const Pack odd_cd = SDO_SHUFFLE_4(c, d, 1, 5, 3, 7);
    a = SDO_SHUFFLE_4(even_ab, even_cd, 0, 1, 4, 5);
    b = SDO_SHUFFLE_4(odd_ab, odd_cd, 0, 1, 4, 5);
    c = SDO_SHUFFLE_4(even_ab, even_cd, 2, 3, 6, 7);
    d = SDO_SHUFFLE_4(odd_ab, odd_cd, 2, 3, 6, 7);
  }
  /// The lower triangle onto the upper one.
  template <int kWidth = 4>
  void mirror() {
    Tile upper = *this;
    upper.transpose();
    b = SDO_SHUFFLE_4(upper.b, b, 0, 5, 6, 7);
    c = SDO_SHUFFLE_4(upper.c, c, 0, 1, 6, 7);
    d = SDO_SHUFFLE_4(upper.d, d, 0, 1, 2, 7);
  }

  PackOf<4>::Type a;
  PackOf<4>::Type b;
  PackOf<4>::Type c;
  PackOf<4>::Type d;
};

/// Transposes a square matrix of `size` columns and rows, a multiple of the width, in place.
template <int kWidth>
void transpose_in_place(double* M, std::ptrdiff_t size) {
  Tile<kWidth> lower;
  Tile<kWidth> upper;
  for (std::ptrdiff_t j = 0; j < size; j += kWidth) {
    lower.load(M + j * size + j, size);
    lower.transpose();
    lower.store(M + j * size + j, size);
    for (std::ptrdiff_t i = j + kWidth; i < size; i += kWidth) {
      lower.load(M + j * size + i, size);
      upper.load(M + i * size + j, size);
      lower.transpose();
      upper.transpose();
      lower.store(M + i * size + j, size);
      upper.store(M + j * size + i, size);
    }
  }
}

/// Copies the lower triangle of such a matrix onto the upper one.
template <int kWidth>
void mirror_lower_of(double* M, std::ptrdiff_t size) {
  Tile<kWidth> tile;
  for (std::ptrdiff_t j = 0; j < size; j += kWidth) {
    tile.load(M + j * size + j, size);
    tile.mirror();
    tile.store(M + j * size + j, size);
    for (std::ptrdiff_t i = j + kWidth; i < size; i += kWidth) {
      tile.load(M + j * size + i, size);
      tile.transpose();
      tile.store(M + i * size + j, size);
    }
  }
}

}  // namespace sampled_data_observers
