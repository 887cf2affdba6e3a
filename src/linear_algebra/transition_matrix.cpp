#include "linear_algebra/transition_matrix.h"

#include <cmath>

#include "linear_algebra/digit_tables.h"

namespace sampled_data_observers {
namespace {

/// The entries (i, j), (i + 1, j), (i, j + 1) and (i + 1, j + 1) of a b.
void multiply_block(const ExtendedMatrix& a, const ExtendedMatrix& b, Eigen::Index i,
                    Eigen::Index j, ExtendedMatrix& result) {
  const Eigen::Index rows = a.rows();
  const long double* of_a = a.data() + i;
  const long double* left = b.data() + j * b.rows();
  const long double* right = left + b.rows();
  long double s00 = 0.0L;
  long double s10 = 0.0L;
  long double s01 = 0.0L;
  long double s11 = 0.0L;
  for (Eigen::Index k = 0; k < b.rows(); ++k, of_a += rows) {
    const long double upper = of_a[0];
    const long double lower = of_a[1];
    s00 += upper * left[k];
    s10 += lower * left[k];
    s01 += upper * right[k];
    s11 += lower * right[k];
  }
  result(i, j) = s00;
  result(i + 1, j) = s10;
  result(i, j + 1) = s01;
  result(i + 1, j + 1) = s11;
}

long double entry_of_product(const ExtendedMatrix& a, const ExtendedMatrix& b, Eigen::Index i,
                             Eigen::Index j) {
  long double sum = 0.0L;
  for (Eigen::Index k = 0; k < b.rows(); ++k) sum += a(i, k) * b(k, j);
  return sum;
}

}  // namespace

ExtendedMatrix product(const ExtendedMatrix& a, const ExtendedMatrix& b) {
  ExtendedMatrix result(a.rows(), b.cols());
  const Eigen::Index rows = a.rows() / 2 * 2;
  const Eigen::Index columns = b.cols() / 2 * 2;
  for (Eigen::Index j = 0; j < columns; j += 2) {
    for (Eigen::Index i = 0; i < rows; i += 2) multiply_block(a, b, i, j, result);
  }
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    for (Eigen::Index i = j < columns ? rows : 0; i < a.rows(); ++i) {
      result(i, j) = entry_of_product(a, b, i, j);
    }
  }
  return result;
}

Transition compose(const Transition& a, const Transition& b) {
  Transition result(a.minus_identity + b.minus_identity +
                    product(a.minus_identity, b.minus_identity));
  // When all modes have decayed, the sum with the identity has cancelled.
  if (result.full.norm() < 0.25L) result.full = product(a.full, b.full);
  return result;
}

int doublings_for(const ExtendedMatrix& M) {
  const long double norm = M.cwiseAbs().colwise().sum().maxCoeff();
  int doublings = 0;
  if (norm > 0.25L) std::frexp(norm * 4.0L, &doublings);
  return doublings;
}

Transition exponential(const ExtendedMatrix& M) {
  // Taylor's remainder at a norm of 1/4 and 16 terms is below 1e-24, relative to M.
  constexpr int kTerms = 16;
  const int doublings = doublings_for(M);
  const ExtendedMatrix scaled = M * std::ldexp(1.0L, -doublings);
  ExtendedMatrix power = scaled;
  ExtendedMatrix sum = scaled;
  for (int k = 2; k <= kTerms; ++k) {
    power = product(power, scaled) / static_cast<long double>(k);
    sum += power;
  }
  return doubled(Transition(sum), doublings);
}

}  // namespace sampled_data_observers
