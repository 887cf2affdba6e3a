#include "certificate/spectral_norm.h"

#include <cmath>
#include <limits>
#include <utility>

#include "linear_algebra/ordered_linear_algebra.h"

namespace sampled_data_observers {
namespace {

constexpr int kSquarings = 10;
/// Each squaring errs by some n² ε of the power's norm, of which the root takes 1/2, 1/4, …
constexpr double kNormRounding = 1e-12;

/// Divides by the Frobenius norm and returns it.
double normalize(double* G, Eigen::Index size) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (!(std::abs(G[i]) <= largest)) largest = std::abs(G[i]);
  }
  if (!(largest > 0.0) || !std::isfinite(largest)) return largest;
  for (Eigen::Index i = 0; i < size; ++i) G[i] /= largest;
  const double norm = std::sqrt(dot(G, G, size));
  for (Eigen::Index i = 0; i < size; ++i) G[i] /= norm;
  return largest * norm;
}

}  // namespace

double spectral_norm_bound(const double* M, Eigen::Index rows, Eigen::Index cols,
                           double* workspace) {
  double* power = workspace;
  double* square = power + cols * cols;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < rows * cols; ++i) {
    if (!(std::abs(M[i]) <= largest)) largest = std::abs(M[i]);
  }
  if (largest == 0.0) return 0.0;
  if (!std::isfinite(largest)) return std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < cols; ++j) {
    for (Eigen::Index i = 0; i < cols; ++i) {
      double sum = 0.0;
      for (Eigen::Index k = 0; k < rows; ++k) {
        sum += (M[i * rows + k] / largest) * (M[j * rows + k] / largest);
      }
      power[j * cols + i] = sum;
    }
  }
  double logarithm = std::log(normalize(power, cols * cols));
  double share = 1.0;
  for (int i = 0; i < kSquarings; ++i) {
    multiply(power, cols, cols, power, cols, square);
    share /= 2.0;
    logarithm += share * std::log(normalize(square, cols * cols));
    std::swap(power, square);
  }
  return largest * std::exp(logarithm / 2.0) * (1.0 + kNormRounding);
}

}  // namespace sampled_data_observers
