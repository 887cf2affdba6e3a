#include "replay/report/error_ellipsoid.h"

#include <cmath>

namespace sampled_data_observers {

bool ErrorEllipsoid::read(const Estimate& estimate, double bound) {
  const ObserverLaw& law = *estimate.law;
  if (!law.has_bound() || !std::isfinite(bound)) return false;
  Q_.resize(law.estimate_size(), law.estimate_size());
  workspace_.resize(law.workspace_size());
  law.error_ellipsoid(estimate.state.data(), workspace_.data(), Q_);
  if (!Q_.allFinite()) return false;
  factor_.compute(Q_);
  return factor_.info() == Eigen::Success;
}

double ErrorEllipsoid::size() const {
  const double sum = 2.0 * factor_.matrixLLT().diagonal().array().log().sum();
  return std::exp(sum / static_cast<double>(Q_.rows()));
}

double ErrorEllipsoid::share(const Eigen::VectorXd& error) const {
  return factor_.matrixL().solve(error).squaredNorm();
}

}  // namespace sampled_data_observers
