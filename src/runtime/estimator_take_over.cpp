// How an estimator goes on from another one, whose law was at work before: late events of that time
// are applied by that law.
#include <algorithm>
#include <utility>

#include "observer/law_decorator.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

/// Whether what was taken over can still be changed by a late event.
bool Estimator::has_earlier() const {
  return taken_over_at_ && timeline_.earliest() == taken_over_at_;
}

/// Whether an event of that stamp belongs to what was taken over, and inside the window.
bool Estimator::is_earlier(Stamp stamp) const {
  if (!has_earlier() || stamp > *taken_over_at_) return false;
  const std::optional<Stamp> newest = timeline_.newest();
  return !newest || stamp >= *newest - options_.history.history;
}

/// Applies an event of before the take-over by the law of its time, and all since then anew.
EventReport Estimator::submit_earlier(Event event, Stamp now) {
  if (event.kind == EventKind::kJump && law_->delays_jumps()) {
    // There, or never, since the law since then did not compute what would be released.
    event.release = std::min(event.release > 0 ? event.release : now, *taken_over_at_);
  }
  EventReport report = earlier_->submit(event, now);
  if (report.outcome == EventOutcome::kDuplicate) {
    // It may count as rejected.
    if (event.kind == EventKind::kJump) go_on_from_earlier();
    return report;
  }
  if (event.kind == EventKind::kInput) {
    if (report.used()) {
      learn_input(event);
    } else {
      miss_input(event.sensor, event.stamp);
    }
  }
  if (report.outcome == EventOutcome::kTooOld) {
    const bool is_of_jump = event.kind == EventKind::kWithdrawal;
    mark_what_is_unseen(is_of_jump ? EventKind::kJump : event.kind, event.index, event.stamp);
  }
  go_on_from_earlier();
  if (timeline_.size() == 0) return report;
  report.rewound += timeline_.size();
  if (report.outcome == EventOutcome::kUsed) report.outcome = EventOutcome::kUsedLate;
  return report;
}

/// What was taken over may be able to mark something only behind its end.
void Estimator::mark_what_is_unseen(EventKind kind, std::uint32_t index, Stamp stamp) {
  if (earlier_->timeline_.earliest_insertion().value_or(0) > *taken_over_at_) {
    insert_rejected(kind, index, stamp);
  }
}

const Estimator& Estimator::at(Stamp stamp) const {
  return has_earlier() && stamp < *taken_over_at_ ? earlier_->at(stamp) : *this;
}

Estimator& Estimator::responsible_for(Stamp stamp) {
  return has_earlier() && stamp < *taken_over_at_ ? earlier_->responsible_for(stamp) : *this;
}

void Estimator::take_over(Estimator& other, Stamp stamp) {
  awaits_sample_ = other.awaits_sample_;
  input_unknown_since_ = other.input_unknown_since_;
  began_at_ = other.began_at_;
  taken_over_at_ = std::max({stamp, other.timeline_.earliest().value_or(stamp),
                             other.timeline_.newest().value_or(stamp)});
  earlier_ = std::make_unique<Estimator>(std::move(other));
  const bool begins = prepare_take_over();
  if (begins) timeline_.restart(*taken_over_at_, restart_state_, earlier_->before_restart_.held);
  if (!begins) timeline_.take_unbegun(earlier_->timeline_);
  if (!begins || awaits_sample_) {
    taken_over_at_.reset();
    other.earlier_ = std::move(earlier_);  // NOLINT(bugprone-use-after-move): it is assigned to
    return;
  }
  Estimator* oldest = earlier_.get();
  for (int kept = 1; kept < kEarlierLaws && oldest->has_earlier(); ++kept) {
    oldest = oldest->earlier_.get();
  }
  oldest->taken_over_at_.reset();
  // Whoever destroys it frees that, too. NOLINTNEXTLINE(bugprone-use-after-move)
  other.earlier_ = std::move(oldest->earlier_);
}

/// After a change of what was taken over.
void Estimator::go_on_from_earlier() {
  if (prepare_take_over())
    timeline_.rebase(*taken_over_at_, restart_state_, earlier_->before_restart_.held);
}

/// Sets the state to start from where what was taken over ends.
bool Estimator::prepare_take_over() {
  if (!prepare_restart(*earlier_, *taken_over_at_)) return false;
  const double* before = earlier_->before_restart_.state.data();
  const ObserverLaw& law = *earlier_->law_;
  law_->observer().start_from(before, restart_state_.data());
  keep_records_of_jumps(law, before, *law_, restart_state_.data());
  keep_records_of_estimate(law, before, *law_, restart_state_.data());
  law_->keep_bound(law.known_bound(before), restart_state_.data());
  if (law.has_bound() && law_->has_bound()) {
    law.known_ellipsoid(before, earlier_->workspace_.data(), ellipsoid_);
    law_->narrow_bound(ellipsoid_, restart_state_.data());
  }
  return true;
}

}  // namespace sampled_data_observers
