#include "certificate/weighted_norm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "certificate/condition.h"
#include "certificate/outward.h"
#include "certificate/rounded_matrix.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

bool is_bounded_by(double square, const Eigen::MatrixXd& from, const Eigen::MatrixXd& to,
                   const MatrixExpression& a) {
  const MatrixExpression room = square * MatrixExpression(from) - transpose(a) * to * a;
  return check({{"norm", room, std::nullopt}}, {}).front().holds();
}

/// Not less than the norm, and as little above the computed one as can be shown.
double shown_norm(double computed, const Eigen::MatrixXd& from, const Eigen::MatrixXd& to,
                  const MatrixExpression& a) {
  const RoundedMatrix rounded = evaluate_with_rounding(a, {});
  if (rounded.value.isZero(0.0) && rounded.error.isZero(0.0)) return 0.0;
  const double square = computed * computed;
  if (is_bounded_by(square, from, to, a)) return computed;
  const double size =
      rounded.value.norm() + std::numeric_limits<double>::epsilon() * rounded.error.norm();
  // Also where the computed norm is zero, or nothing beside what was rounded away.
  double excess = std::max(
      1e-9 * square, 1e-40 * to.diagonal().maxCoeff() * size * size / from.diagonal().maxCoeff());
  constexpr int kAttempts = 150;
  for (int i = 0; i < kAttempts; ++i, excess *= 4.0) {
    if (is_bounded_by(square + excess, from, to, a)) return raised(std::sqrt(square + excess));
  }
  throw std::invalid_argument(
      "how far the plant's or gains' matrices move an error in the norm of the certificate's P is "
      "lost in rounding: write states in units in which they are of like size, and design again");
}

}  // namespace

double norm_between(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to,
                    const MatrixExpression& a) {
  const Eigen::MatrixXd value = evaluate(a, {});
  const double square = largest_generalized_eigenvalue(value.transpose() * to * value, from);
  return shown_norm(raised(std::sqrt(std::max(0.0, square))), from, to, a);
}

double norm_into(const Eigen::MatrixXd& P, const Eigen::MatrixXd& a) {
  if (a.cols() == 0) return 0.0;
  const double square = largest_eigenvalue_above(a.transpose() * P * a);
  return shown_norm(std::sqrt(std::max(0.0, square)), Eigen::MatrixXd::Identity(a.cols(), a.cols()),
                    P, a);
}

}  // namespace sampled_data_observers
