// Each compilation of the kernels beside the plain loops that say what they compute: the same bits.
#include "linear_algebra/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "linear_algebra/joseph_update.h"
#include "linear_algebra/ordered_linear_algebra.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

using Numbers = std::vector<double>;
using Index = std::ptrdiff_t;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Index kSizes[] = {1, 2, 3, 4, 5, 7, 8, 11, 12, 13, 15, 16, 17, 20, 33};
constexpr int kDigits = 3;

enum class Pattern { kDense, kChain, kDiagonal };
const Pattern kPatterns[] = {Pattern::kDense, Pattern::kChain, Pattern::kDiagonal};

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

std::vector<const Kernels*> compilations() {
  std::vector<const Kernels*> all = {&baseline_kernels()};
  if (avx2_kernels() != nullptr) all.push_back(avx2_kernels());
  return all;
}

void expect_same_bits(const Numbers& expected, const Numbers& found, Index n) {
  EXPECT_EQ(0, std::memcmp(expected.data(), found.data(), expected.size() * sizeof(double)))
      << "n = " << n;
}

/// A flow of n states in three digits, plain and as kernels take it.
struct Flow {
  Flow(Index states, Index inputs, bool has_constant, Pattern pattern)
      : shape{states, inputs, has_constant} {
    const Index n = states;
    const Index rows = padded(n);
    const Index columns = n + inputs + (has_constant ? 1 : 0);
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j) {
        if (is_entry(i, j, pattern)) offset.push_back(static_cast<std::int32_t>(j * rows));
      }
      begin.push_back(static_cast<std::int32_t>(offset.size()));
    }
    for (int digit = 0; digit < kDigits; ++digit) {
      Numbers M(at(n * columns));
      for (Index j = 0; j < columns; ++j) {
        for (Index i = 0; i < n; ++i) {
          if (j >= n || is_entry(i, j, pattern)) M[at(j * n + i)] = number();
        }
      }
      Numbers M_padded(at(rows * columns));
      for (Index j = 0; j < columns; ++j) {
        std::copy_n(&M[at(j * n)], n, &M_padded[at(j * rows)]);
      }
      Numbers noise = covariance(n);
      Numbers entries;
      for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) {
          if (is_entry(i, j, pattern)) entries.push_back(M[at(j * n + i)]);
        }
      }
      for (Index j = 0; j < n; ++j) {
        entries.insert(entries.end(), &noise[at(j * n + first_row_of_lower(j))],
                       &noise[at(j * n)] + n);
        entries.resize(entries.size() + at(rows - n));
      }
      plain.push_back(M);
      affine.push_back(M_padded);
      noises.push_back(noise);
      covariances.push_back(entries);
    }
    for (const Numbers& block : affine) affine_blocks.push_back(block.data());
    for (const Numbers& block : covariances) covariance_blocks.push_back(block.data());
    u.resize(at(inputs));
    for (double& entry : u) entry = number();
  }

  static bool is_entry(Index i, Index j, Pattern pattern) {
    if (pattern == Pattern::kChain) return j == i || j == i + 3 || j == i + 6;
    return pattern == Pattern::kDense || i == j;
  }
  static double number() { return std::uniform_real_distribution<>(-1.0, 1.0)(generator()); }
  static std::mt19937& generator() {
    static std::mt19937 random(5);
    return random;
  }
  static Numbers covariance(Index n) {
    Numbers P(at(n * n));
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i <= j; ++i)
        P[at(j * n + i)] = P[at(i * n + j)] = number() + (i == j ? 2 : 0);
    }
    return P;
  }

  void apply(Numbers& x) const {
    const Index n = shape.states;
    for (const Numbers& M : plain) {
      Numbers next(at(n));
      add_product(M.data(), n, n, x.data(), next.data());
      add_product(M.data() + n * n, n, shape.inputs, u.data(), next.data());
      for (Index i = 0; shape.has_constant && i < n; ++i) {
        next[at(i)] += M[at(n * (n + shape.inputs) + i)];
      }
      x = next;
    }
  }
  void apply_to_covariance(Numbers& P) const {
    const Index n = shape.states;
    Numbers product(at(n * n));
    for (std::size_t digit = 0; digit < plain.size(); ++digit) {
      multiply(plain[digit].data(), n, n, P.data(), n, product.data());
      P = noises[digit];
      add_symmetric_product(product.data(), plain[digit].data(), n, n, P.data());
    }
  }
  void apply_to_covariance(const Kernels& kernels, Numbers& P) const {
    Numbers scratch(at(covariance_scratch(shape.states)), kNan);
    kernels.covariance_flow(covariance_blocks.data(), kDigits, {begin.data(), offset.data()},
                            shape.states, P.data(), scratch.data());
  }

  FlowShape shape;
  std::vector<std::int32_t> begin = {0};
  std::vector<std::int32_t> offset;
  std::vector<Numbers> plain, affine, noises, covariances;
  std::vector<const double*> affine_blocks, covariance_blocks;
  Numbers u;
};

TEST(KernelsTest, AFlowIsThatOfPlainProducts) {
  for (const Index n : kSizes) {
    for (const Index inputs : {0, 2}) {
      for (const bool has_constant : {false, true}) {
        const Flow flow(n, inputs, has_constant, Pattern::kDense);
        Numbers x(at(n));
        for (double& entry : x) entry = Flow::number();
        x.back() = -0.0;
        Numbers expected = x;
        flow.apply(expected);
        for (const Kernels* kernels : compilations()) {
          Numbers found = x;
          Numbers scratch(at(n), kNan);
          kernels->linear_flow[n <= kPanelRows ? n : 0](flow.affine_blocks.data(), kDigits,
                                                        flow.shape, flow.u.data(), found.data(),
                                                        scratch.data());
          expect_same_bits(expected, found, n);
        }
      }
    }
  }
}

TEST(KernelsTest, ZerosArePositive) {
  // 0 · x − 0: the sum begins with a positive zero.
  for (const Index n : kSizes) {
    Flow flow(n, 0, false, Pattern::kDense);
    for (Numbers& block : flow.plain) std::fill(block.begin(), block.end(), -0.0);
    for (Numbers& block : flow.affine) std::fill(block.begin(), block.end(), -0.0);
    for (const Kernels* kernels : compilations()) {
      Numbers x(at(n), 1.0);
      Numbers scratch(at(n));
      kernels->linear_flow[n <= kPanelRows ? n : 0](flow.affine_blocks.data(), kDigits, flow.shape,
                                                    nullptr, x.data(), scratch.data());
      expect_same_bits(Numbers(at(n), 0.0), x, n);
    }
  }
}

TEST(KernelsTest, TheFlowOfACovarianceIsThatOfPlainProducts) {
  for (const Index n : kSizes) {
    for (const Pattern pattern : kPatterns) {
      const Flow flow(n, 0, false, pattern);
      const Numbers P = Flow::covariance(n);
      Numbers expected = P;
      flow.apply_to_covariance(expected);
      for (const Kernels* kernels : compilations()) {
        Numbers found = P;
        flow.apply_to_covariance(*kernels, found);
        expect_same_bits(expected, found, n);
      }
    }
  }
}

/// As plant/covariance_step.h has it, by plain products.
void step_covariance(const Numbers& F, const Numbers& Q, Index n, double h, Numbers& P) {
  Numbers Phi(at(n * n));
  Numbers scaled(at(n * n));
  Numbers product(at(n * n));
  for (Index i = 0; i < n; ++i) Phi[at(i * n + i)] = 1.0;
  for (int divisor = 4; divisor > 0; --divisor) {
    for (std::size_t i = 0; i < Phi.size(); ++i) scaled[i] = h / divisor * Phi[i];
    multiply(F.data(), n, n, scaled.data(), n, Phi.data());
    for (Index i = 0; i < n; ++i) Phi[at(i * n + i)] += 1.0;
  }
  for (std::size_t i = 0; i < P.size(); ++i) P[i] += 0.5 * h * Q[i];
  multiply(Phi.data(), n, n, P.data(), n, product.data());
  P.assign(P.size(), 0.0);
  add_symmetric_product(product.data(), Phi.data(), n, n, P.data());
  for (std::size_t i = 0; i < P.size(); ++i) P[i] += 0.5 * h * Q[i];
}

TEST(KernelsTest, TheStepOfACovarianceIsThatOfPlainProducts) {
  for (const Index n : kSizes) {
    for (const Pattern pattern : kPatterns) {
      const Flow flow(n, 0, false, pattern);
      Numbers F = flow.plain[0];
      F[0] = 0.0;
      const Numbers& Q = flow.noises[0];
      Numbers expected = Flow::covariance(n);
      const Numbers P = expected;
      step_covariance(F, Q, n, 0.125, expected);
      for (const Kernels* kernels : compilations()) {
        Numbers found = P;
        Numbers scratch(at(covariance_step_scratch(n)), kNan);
        kernels->covariance_step(F.data(), Q.data(), n, 0.125, found.data(), scratch.data());
        expect_same_bits(expected, found, n);
      }
    }
  }
}

TEST(KernelsTest, WhatIsNotFiniteStaysThoughZerosAreLeftOut) {
  for (const Pattern pattern : kPatterns) {
    for (const double value : {kNan, std::numeric_limits<double>::infinity()}) {
      const Index n = 7;
      const Flow flow(n, 0, false, pattern);
      for (Index entry = 0; entry < n * n; ++entry) {
        for (const Kernels* kernels : compilations()) {
          Numbers P = Flow::covariance(n);
          P[at(entry)] = P[at(entry % n * n + entry / n)] = value;
          flow.apply_to_covariance(*kernels, P);
          EXPECT_FALSE(kernels->all_within(P.data(), n * n, 1e300)) << entry;
        }
      }
    }
  }
}

/// What joseph_update() is to compute.
void plain_joseph_update(const JosephUpdate& update, double* P, double* correction) {
  const Index n = update.size;
  Numbers column(at(n));
  Numbers gain(at(n));
  Numbers rest(at(n));
  std::fill_n(correction, n, 0.0);
  for (Index output = 0; output < update.outputs; ++output) {
    const double* c = update.rows + output * n;
    multiply(P, n, n, c, 1, column.data());
    const double variance = 1.0 + std::max(0.0, dot(c, column.data(), n));
    const double left = update.innovation[output] - dot(c, correction, n);
    for (Index i = 0; i < n; ++i) {
      gain[at(i)] = column[at(i)] / variance;
      correction[i] += gain[at(i)] * left;
    }
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < n; ++i) P[j * n + i] -= gain[at(i)] * column[at(j)];
    }
    multiply(P, n, n, c, 1, rest.data());
    for (Index j = 0; j < n; ++j) {
      for (Index i = j; i < n; ++i) P[j * n + i] += (gain[at(i)] - rest[at(i)]) * gain[at(j)];
    }
    mirror_lower(P, n);
  }
}

TEST(KernelsTest, AnUpdateIsThatOfPlainProducts) {
  for (const Index n : kSizes) {
    for (const bool is_sparse : {false, true}) {
      constexpr Index kOutputs = 3;
      Numbers rows(at(n * kOutputs));
      Numbers innovation(at(kOutputs));
      for (Index output = 0; output < kOutputs; ++output) {
        innovation[at(output)] = Flow::number();
        for (Index i = 0; i < n; ++i) {
          if (!is_sparse || i == (5 * output) % n) rows[at(output * n + i)] = Flow::number();
        }
      }
      const Numbers P = Flow::covariance(n);
      const JosephUpdate update = {rows.data(), kOutputs, n, innovation.data()};
      Numbers expected = P;
      Numbers correction(at(n));
      plain_joseph_update(update, expected.data(), correction.data());
      for (const Kernels* kernels : compilations()) {
        Numbers found = P;
        Numbers found_correction(at(n), kNan);
        Numbers scratch(at(joseph_scratch(n)), kNan);
        kernels->joseph_update(update, found.data(), found_correction.data(), scratch.data());
        expect_same_bits(expected, found, n);
        expect_same_bits(correction, found_correction, n);
      }
    }
  }
}

TEST(KernelsTest, OneEntryOutsideIsFoundWhereverItIs) {
  for (const Kernels* kernels : compilations()) {
    EXPECT_TRUE(kernels->all_within(nullptr, 0, 1.0));
    for (Index size = 1; size < 12; ++size) {
      Numbers x(at(size), -1.0);
      EXPECT_TRUE(kernels->all_within(x.data(), size, 1.0));
      for (double& entry : x) {
        for (const double outside : {1.5, -1.5, kNan, std::numeric_limits<double>::infinity()}) {
          entry = outside;
          EXPECT_FALSE(kernels->all_within(x.data(), size, 1.0));
        }
        entry = 0.5;
      }
    }
  }
}

TEST(KernelsTest, AllocateNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const Index n = 20;
  Numbers P = Flow::covariance(n);
  Numbers row(at(n), 1.0);
  Numbers correction(at(n));
  Numbers scratch(at(joseph_scratch(n)));
  const double innovation = 0.1;
  const std::size_t before = test::allocations();
  joseph_update(row.data(), 1, n, &innovation, P.data(), correction.data(), scratch.data());
  EXPECT_EQ(before, test::allocations());
}

}  // namespace
}  // namespace sampled_data_observers
