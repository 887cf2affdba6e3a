#include "certificate/sublevel_set.h"

#include <cmath>
#include <limits>

#include "certificate/outward.h"
#include "certificate/rounded_matrix.h"

namespace sampled_data_observers {
namespace {

/// Of the bound on the rounding of an inverse, which is one to first order.
constexpr double kHigherOrders = 2.0;

/// Added to the diagonal it outweighs any change of the entries X_ij by a share of it of
/// √(X_ii X_jj)/n: their own rounding, and that of what is made of them.
constexpr double kRoomOnDiagonal = 1e-9;

}  // namespace

Eigen::MatrixXd inverse_above(const Eigen::MatrixXd& P, double least) {
  const Eigen::Index n = P.rows();
  const Eigen::MatrixXd symmetric = (P + P.transpose()) / 2.0;
  const RoundedMatrix computed = evaluate_with_rounding(inverse(MatrixExpression(symmetric)), {});
  Eigen::MatrixXd X = (computed.value + computed.value.transpose()) / 2.0;
  const Eigen::MatrixXd error = kHigherOrders * std::numeric_limits<double>::epsilon() / 2.0 *
                                (computed.error + computed.error.transpose());
  if (X.allFinite() && error.allFinite() && X.diagonal().minCoeff() > 0.0) {
    // |E_ij| <= error_ij gives E <= diag(Σ_j error_ij d_j/d_i), whatever d > 0 is.
    const Eigen::VectorXd d = X.diagonal().cwiseSqrt().cwiseInverse();
    X.diagonal() += d.cwiseInverse().cwiseProduct(error * d);
    X.diagonal() *= 1.0 + kRoomOnDiagonal;
    if (X.allFinite()) return X;
  }
  return Eigen::MatrixXd::Identity(n, n) * raised(1.0 / least);
}

SublevelSet::SublevelSet(const Eigen::MatrixXd& P, double least)
    : form_(P, P.cwiseAbs()),
      inverse_(inverse_above(P, least)),
      widths_(
          inverse_.diagonal().unaryExpr([](double entry) { return raised(std::sqrt(entry)); })) {}

double SublevelSet::radius_around(const Eigen::Ref<const Eigen::MatrixXd>& Q) const {
  return raised(std::sqrt(form_.over(Q)));
}

Eigen::MatrixXd inverse_above(const MatrixExpression& P, const NamedMatrices& values,
                              const std::string& name) {
  const RoundedMatrix rounded = evaluate_with_rounding(P, values);
  Eigen::MatrixXd below = (rounded.value + rounded.value.transpose()) / 2.0;
  // |Σ E_ij x_i x_j| <= Σ_i x_i² Σ_j |E_ij| d_i / d_j for any d > 0.
  const Eigen::VectorXd d = below.diagonal().cwiseAbs().cwiseSqrt();
  const Eigen::MatrixXd weighted =
      d.asDiagonal() * (rounded.error + rounded.error.transpose()) * d.cwiseInverse().asDiagonal();
  below.diagonal() -= std::numeric_limits<double>::epsilon() * weighted.rowwise().sum();
  return inverse_above(below, positive_least_eigenvalue(below, name));
}

}  // namespace sampled_data_observers
