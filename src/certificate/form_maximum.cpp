#include "certificate/form_maximum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "certificate/outward.h"

namespace sampled_data_observers {
namespace {

constexpr double kTermsOfEntries = 64.0;

/// Of a sum of so many products with an entry of M, relative to their sizes.
double rounding_of(double terms) {
  return (kTermsOfEntries + terms) * std::numeric_limits<double>::epsilon();
}

}  // namespace

double FormMaximum::over(const Eigen::Ref<const Eigen::MatrixXd>& Q) const {
  return raised(std::min(trace(Q), norm(Q)));
}

double FormMaximum::trace(const Eigen::Ref<const Eigen::MatrixXd>& Q) const {
  double sum = 0.0;
  double size = 0.0;
  for (Eigen::Index j = 0; j < Q.cols(); ++j) {
    for (Eigen::Index i = 0; i < Q.rows(); ++i) {
      sum += M_(i, j) * Q(i, j);
      size += size_(i, j) * std::abs(Q(i, j));
    }
  }
  return std::max(0.0, sum) + rounding_of(static_cast<double>(Q.size())) * size;
}

/// Of (M Q)_ij (M Q)_ji, summed: where each factor is off by r times its size s, the product is by
/// r (|a| s' + |a'| s) + r² s s' <= (2 r + r²) s s'.
double FormMaximum::norm(const Eigen::Ref<const Eigen::MatrixXd>& Q) const {
  struct Entry {
    double value = 0.0;
    double size = 0.0;
  };
  const auto entry = [&](Eigen::Index i, Eigen::Index j) {
    Entry result;
    for (Eigen::Index k = 0; k < Q.rows(); ++k) {
      result.value += M_(i, k) * Q(k, j);
      result.size += size_(i, k) * std::abs(Q(k, j));
    }
    return result;
  };
  double sum = 0.0;
  double size = 0.0;
  for (Eigen::Index j = 0; j < Q.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      const Entry above = entry(i, j);
      const Entry below = entry(j, i);
      const double times = i == j ? 1.0 : 2.0;
      sum += times * above.value * below.value;
      size += times * above.size * below.size;
    }
  }
  const double rounding = rounding_of(static_cast<double>(Q.size()));
  return std::sqrt(std::max(0.0, sum) + 4.0 * rounding * size);
}

}  // namespace sampled_data_observers
