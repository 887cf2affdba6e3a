#include "design/high_gain_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kLargestEll = 1e4;
constexpr double kStep = 1.25;
constexpr double kAccuracy = 1.05;

/// P with Fᵀ P + P F = −I
Eigen::MatrixXd lyapunov_matrix(const Eigen::MatrixXd& F) {
  const Eigen::Index d = F.rows();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(d * d, d * d);
  for (Eigen::Index i = 0; i < d; ++i) {
    for (Eigen::Index j = 0; j < d; ++j) {
      for (Eigen::Index k = 0; k < d; ++k) {
        system(i + d * j, k + d * j) += F(k, i);
        system(i + d * j, i + d * k) += F(k, j);
      }
    }
  }
  const Eigen::MatrixXd minus_identity = -Eigen::MatrixXd::Identity(d, d);
  const Eigen::MatrixXd P =
      solve_linear(system, Eigen::Map<const Eigen::VectorXd>(minus_identity.data(), d * d));
  return Eigen::Map<const Eigen::MatrixXd>(P.data(), d, d);
}

}  // namespace

Eigen::MatrixXd closed_loop_of(const Eigen::VectorXd& K) {
  const Eigen::Index d = K.size();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(d, d);
  result.col(0) = -K;
  for (Eigen::Index i = 0; i + 1 < d; ++i) result(i, i + 1) = 1.0;
  return result;
}

HighGainError::HighGainError(const Eigen::VectorXd& K, Eigen::VectorXd slopes)
    : slopes_(std::move(slopes)),
      P_(lyapunov_matrix(closed_loop_of(K))),
      root_(cholesky_root(P_)),
      inverse_root_(inverse_of(root_)),
      largest_(max_eigenvalue(P_)) {}

double HighGainError::flow_decay(double ell) const {
  const Eigen::Index d = slopes_.size();
  Eigen::VectorXd weighted = slopes_;
  for (Eigen::Index i = 0; i < d; ++i) {
    weighted(i) *= std::pow(ell, static_cast<double>(i + 1 - d));
  }
  return (ell - 2.0 * P_.col(d - 1).norm() * weighted.norm()) / largest_;
}

double HighGainError::sufficient_ell() const {
  if (!slopes_.allFinite()) return kNone;
  double low = 1e-9;
  double high = 1.0;
  if (flow_decay(low) > 0.0) return 0.0;
  while (!(flow_decay(high) > 0.0)) high *= 2.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (flow_decay(middle) > 0.0 ? high : low) = middle;
  }
  return high;
}

double HighGainError::growth(const std::vector<Eigen::MatrixXd>& jumps, double ell) const {
  const Eigen::Index d = slopes_.size();
  Eigen::VectorXd scale(d);
  for (Eigen::Index i = 0; i < d; ++i) scale(i) = std::pow(ell, static_cast<double>(i));
  double largest = 0.0;
  for (const Eigen::MatrixXd& J : jumps) {
    const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * J * scale.asDiagonal();
    // A slope that is no number is larger than any.
    const double norm = scaled.allFinite() ? norm2(root_ * scaled * inverse_root_) : kNone;
    largest = std::max(largest, norm);
  }
  return largest * largest;
}

double HighGainError::ell_for_jumps(const std::vector<Eigen::MatrixXd>& jumps,
                                    double dwell_time) const {
  const double least = sufficient_ell();
  const auto falls = [&](double ell) {
    return flow_decay(ell) * dwell_time > std::log(growth(jumps, ell));
  };
  double ell = kLargestEll * std::max(1.0 / dwell_time, least);
  if (!std::isfinite(ell) || !falls(ell)) return kNone;
  const double lowest = std::max(least, 1.0 / (kLargestEll * dwell_time));
  while (ell / kStep > lowest && falls(ell / kStep)) ell /= kStep;
  double bad = std::max(lowest, ell / kStep);
  while (ell > kAccuracy * bad) {
    const double middle = std::sqrt(ell * bad);
    (falls(middle) ? ell : bad) = middle;
  }
  return ell;
}

}  // namespace sampled_data_observers
