// What is published of a guaranteed bound, and what another law is to know of it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "certificate/guaranteed_bound.h"

namespace sampled_data_observers {
namespace {

/// Of |x̂| and each state: rounding of the estimate.
constexpr double kFloor = 64.0 * std::numeric_limits<double>::epsilon();

/// Added to the diagonal of an ellipsoid, of which it is a share, it outweighs the rounding of its
/// entries, here and where it is carried over to other coordinates.
constexpr double kRoomForRounding = 1e-9;

double norm(const double* vector, Eigen::Index size) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) sum += vector[i] * vector[i];
  return std::sqrt(sum);
}

}  // namespace

double GuaranteedBound::rounding(const double* state) const {
  return kFloor * static_cast<double>(estimate_size()) * norm(state, estimate_size());
}

double GuaranteedBound::with_rounding(double bound, const double* state) const {
  return bound + rounding(state);
}

double GuaranteedBound::error_bound(const double* state) const {
  if (bound_loss(state) != BoundLoss::kNone) return std::numeric_limits<double>::infinity();
  return with_rounding(bound_of(now_, state), state);
}

void GuaranteedBound::state_bounds(const double* state, double* workspace,
                                   Eigen::Ref<Eigen::VectorXd> bounds) const {
  if (bound_loss(state) != BoundLoss::kNone) {
    bounds.setConstant(std::numeric_limits<double>::infinity());
    return;
  }
  bound_->state_bounds(now_.bound.of(state), bound_workspace_.of(workspace), bounds);
  const double of_norm = bound_of(now_, state);
  // Not a number is not smaller.
  for (Eigen::Index i = 0; i < bounds.size(); ++i) {
    bounds(i) = with_rounding(bounds(i) < of_norm ? bounds(i) : of_norm, state);
  }
}

void GuaranteedBound::error_ellipsoid(const double* state, double* workspace,
                                      Eigen::Ref<Eigen::MatrixXd> Q) const {
  if (bound_loss(state) != BoundLoss::kNone) {
    StateBound::error_ellipsoid(state, workspace, Q);
  } else {
    known_ellipsoid(state, workspace, Q);
  }
}

void GuaranteedBound::known_ellipsoid(const double* state, double* workspace,
                                      Eigen::Ref<Eigen::MatrixXd> Q) const {
  if (now_.loss.of(state) != BoundLoss::kNone) {
    StateBound::known_ellipsoid(state, workspace, Q);
    return;
  }
  bound_->ellipsoid(now_.bound.of(state), bound_workspace_.of(workspace), Q);
  if (!Q.allFinite()) {
    const double radius = bound_of(now_, state);
    Q.setZero();
    Q.diagonal().setConstant(radius * radius);
  }
  // The sum with a ball of radius r lies in (1 + r/s) Q + (r² + r s) I, whatever s > 0 is.
  const double r = rounding(state);
  if (r > 0.0) {
    const double s = std::max(r, std::sqrt(std::max(0.0, Q.diagonal().minCoeff())));
    Q *= 1.0 + r / s;
    Q.diagonal().array() += r * (r + s);
  }
  Q.diagonal() *= 1.0 + kRoomForRounding;
}

PublishedBound GuaranteedBound::known_bound(const double* state) const {
  return {with_rounding(bound_of(now_, state), state), now_.loss.of(state)};
}

/// Whether the plant may be yet to make a jump that was told.
bool GuaranteedBound::is_near_jump(const double* state) const {
  const double since = std::min(since_jump_.of(state), since_start_.of(state));
  return jump_stamp_error_ > 0 && since <= static_cast<double>(jump_stamp_error_);
}

void GuaranteedBound::keep_bound(const PublishedBound& known, double* state) const {
  // As if a jump had been told here: the law before may have taken one just now.
  if (jump_stamp_error_ > 0) since_jump_.restart(state);
  if (std::isfinite(known.value)) {
    bound_->begin(known.value, then_.bound.of(state));
    go_on_from_then(state);
  } else {
    const BoundLoss loss = known.loss == BoundLoss::kNone ? BoundLoss::kNotVouched : known.loss;
    lose(loss, state);
    // It tells more than that the mode is open.
    then_.loss.set(loss, state);
    now_.loss.set(loss, state);
  }
}

void GuaranteedBound::narrow_bound(const Eigen::Ref<const Eigen::MatrixXd>& Q,
                                   double* state) const {
  if (then_.loss.of(state) != BoundLoss::kNone || !Q.allFinite()) return;
  bound_->narrow(Q, then_.bound.of(state));
  go_on_from_then(state);
}

BoundLoss GuaranteedBound::bound_loss(const double* state) const {
  const BoundLoss loss = now_.loss.of(state);
  return loss == BoundLoss::kNone && is_near_jump(state) ? BoundLoss::kNearJump : loss;
}

}  // namespace sampled_data_observers
