#include "plant/covariance_step.h"

#include <algorithm>
#include <utility>

#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {
namespace {

/// M ← I + scale F M, with `product` as scratch.
void horner_step(const double* F, double scale, Eigen::Index n, double* M, double* product) {
  for (Eigen::Index j = 0; j < n; ++j) {
    double* column = product + j * n;
    std::fill_n(column, n, 0.0);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double factor = scale * M[j * n + k];
      if (factor == 0.0) continue;
      for (Eigen::Index i = 0; i < n; ++i) column[i] += F[k * n + i] * factor;
    }
    column[j] += 1.0;
  }
  std::copy_n(product, n * n, M);
}

/// C ← A Bᵀ of square matrices, where much of B is zero; of column j the entries from `first`(j)
/// on.
template <class First>
void multiply_by_sparse_transposed(const double* A, const double* B, Eigen::Index n, double* C,
                                   First first) {
  for (Eigen::Index j = 0; j < n; ++j) {
    double* column = C + j * n;
    std::fill_n(column, n, 0.0);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double factor = B[k * n + j];
      if (factor == 0.0) continue;
      for (Eigen::Index i = first(j); i < n; ++i) column[i] += A[k * n + i] * factor;
    }
  }
}

}  // namespace

void covariance_step(const double* F, const double* Q, Eigen::Index n, double h, double* P,
                     double* workspace) {
  double* Phi = workspace;
  double* product = workspace + n * n;
  std::fill_n(Phi, n * n, 0.0);
  for (Eigen::Index i = 0; i < n; ++i) Phi[i * n + i] = 1.0;
  for (const double divisor : {4.0, 3.0, 2.0, 1.0}) horner_step(F, h / divisor, n, Phi, product);
  const double half = 0.5 * h;
  for (Eigen::Index i = 0; i < n * n; ++i) P[i] += half * Q[i];
  multiply_by_sparse_transposed(P, Phi, n, product, [](Eigen::Index) { return Eigen::Index{0}; });
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < j; ++i) std::swap(product[j * n + i], product[i * n + j]);
  }
  multiply_by_sparse_transposed(product, Phi, n, P, [](Eigen::Index j) { return j; });
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) P[j * n + i] += half * Q[j * n + i];
  }
  mirror_lower(P, n);
}

}  // namespace sampled_data_observers
