#include "certificate/form_maximum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "certificate/outward.h"

namespace sampled_data_observers {

double FormMaximum::over(const Eigen::Ref<const Eigen::MatrixXd>& Q) const {
  constexpr double kTermsOfEntries = 64.0;
  double trace = 0.0;
  double size = 0.0;
  for (Eigen::Index j = 0; j < Q.cols(); ++j) {
    for (Eigen::Index i = 0; i < Q.rows(); ++i) {
      trace += M_(i, j) * Q(i, j);
      size += size_(i, j) * std::abs(Q(i, j));
    }
  }
  const double rounding =
      (kTermsOfEntries + static_cast<double>(Q.size())) * std::numeric_limits<double>::epsilon();
  return raised(std::max(0.0, trace) + rounding * size);
}

}  // namespace sampled_data_observers
