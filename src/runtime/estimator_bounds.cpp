// The bounds that an estimator publishes.
#include <cmath>
#include <optional>

#include "sampled_data_observers/observer/plant_observer.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

PublishedBound Estimator::bound(const Estimate& estimate, Stamp now) const {
  return published_bound(estimate, withheld(estimate.stamp, now));
}

void Estimator::state_bounds(const Estimate& estimate, Stamp now,
                             Eigen::Ref<Eigen::VectorXd> bounds) {
  published_state_bounds(estimate, bound(estimate, now), workspace_of(*estimate.law), bounds);
}

void Estimator::error_ellipsoid(const Estimate& estimate, Stamp now,
                                Eigen::Ref<Eigen::MatrixXd> Q) {
  const PublishedBound known = bound(estimate, now);
  if (std::isfinite(known.value)) {
    estimate.law->error_ellipsoid(estimate.state.data(), workspace_of(*estimate.law), Q);
  } else {
    Q.setZero();
    Q.diagonal().setConstant(known.value);
  }
}

/// Of the law of this estimator or of one that it took over.
double* Estimator::workspace_of(const ObserverLaw& law) {
  Estimator* owner = this;
  while (owner->law_.get() != &law) owner = owner->earlier_.get();
  return owner->workspace_.data();
}

/// Why a bound at an estimate's stamp can't be given yet, or not at all, though one is known:
/// inputs or jumps of before it may still come, or a jump that was told with a later stamp was
/// before it, perhaps. Nothing else of later events: what is published must not depend on how many
/// of them have arrived.
BoundLoss Estimator::withheld(Stamp stamp, Stamp now) const {
  const bool jumps = law_->observer().plant().jumps();
  const Duration latest = options_.latency + (jumps ? options_.jump_stamp_error : 0);
  if (has_other_events_ && now - stamp < latest) return BoundLoss::kStillOnTheirWay;
  return is_before_jump(stamp) ? BoundLoss::kNearJump : BoundLoss::kNone;
}

bool Estimator::is_before_gap(Stamp stamp) const { return shows_gap_behind(stamp).value_or(false); }

/// Of the next jump, or withdrawal of one; nothing where there is none.
std::optional<bool> Estimator::shows_gap_behind(Stamp stamp) const {
  if (has_earlier() && stamp < *taken_over_at_) {
    const std::optional<bool> found = earlier_->shows_gap_behind(stamp);
    if (found) return found;
  }
  const std::optional<Timeline::Around> around = timeline_.around_next_jump(stamp);
  if (!around) return std::nullopt;
  return law_->skipped_jumps(around->after) > law_->skipped_jumps(around->before);
}

/// Whether a jump was told with a stamp so little later that it may have been before.
bool Estimator::is_before_jump(Stamp stamp) const {
  const Duration error = options_.jump_stamp_error;
  if (error == 0) return false;
  return timeline_.has_jump(stamp, stamp + error) ||
         (has_earlier() && earlier_->is_before_jump(stamp));
}

}  // namespace sampled_data_observers
