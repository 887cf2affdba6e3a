#include "certificate/flow_growth.h"

#include <algorithm>
#include <cmath>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// How much e^{(c − real part) horizon} is above 1, in the exponent.
constexpr double kSlack = 0.05;
/// Of the rate, relative to what it is the difference of.
constexpr double kMargin = 1e-12;
constexpr int kMaxDoublings = 64;

FlowGrowth in_norm(const Eigen::MatrixXd& A, const Eigen::MatrixXd& W) {
  FlowGrowth growth;
  growth.W = W;
  growth.inverse_W = inverse_of(W);
  const Eigen::MatrixXd weighed = W * A * growth.inverse_W;
  const double rounding = (W.cwiseAbs() * A.cwiseAbs() * growth.inverse_W.cwiseAbs()).norm();
  growth.rate = max_eigenvalue(weighed) + kMargin * static_cast<double>(A.rows()) * rounding;
  return growth;
}

/// Σ Eʲᵀ Eʲ of E = e^{Bh}, a sum for the integral: the number of terms doubles with each step.
Eigen::MatrixXd gramian(const Eigen::MatrixXd& B, double h) {
  Eigen::MatrixXd E = exponential_of(B * h);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(B.rows(), B.rows());
  for (int i = 0; i < kMaxDoublings; ++i) {
    const Eigen::MatrixXd added = E.transpose() * sum * E;
    if (!added.allFinite()) break;
    sum += added;
    if (added.norm() <= 1e-12 * sum.norm()) break;
    E = E * E;
  }
  return (sum + sum.transpose()) / 2.0;
}

}  // namespace

FlowGrowth flow_growth(const Eigen::MatrixXd& A, double horizon) {
  const Eigen::Index n = A.rows();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  FlowGrowth plain = in_norm(A, identity);
  const double c = eigenvalues_of(A).real().maxCoeff() + kSlack / horizon;
  const Eigen::MatrixXd B = A - c * identity;
  const double size = B.norm();
  if (!(size > 0.0)) return plain;
  const Eigen::MatrixXd W = cholesky_root(gramian(B, 0.1 / size));
  if (!W.allFinite()) return plain;
  const FlowGrowth weighted = in_norm(A, W);
  const bool is_better =
      std::isfinite(weighted.rate) && weighted.inverse_W.allFinite() && weighted.rate < plain.rate;
  return is_better ? weighted : plain;
}

}  // namespace sampled_data_observers
