#include "sampled_data_observers/runtime/estimator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

IntervalCheck check(Duration interval, const SamplingBounds& bounds) {
  if (interval < bounds.T1) return IntervalCheck::kShort;
  if (interval > bounds.T2) return IntervalCheck::kLong;
  return IntervalCheck::kWithin;
}

EventOutcome outcome_of(const Timeline::InsertReport& report) {
  switch (report.insertion) {
    case Timeline::Insertion::kDuplicate:
      return EventOutcome::kDuplicate;
    case Timeline::Insertion::kBeforeWindow:
      return EventOutcome::kTooOld;
    case Timeline::Insertion::kAppended:
    case Timeline::Insertion::kRewound:
      break;
  }
  switch (report.effect) {
    case Effect::kNotFinite:
      return EventOutcome::kWouldOverflow;
    case Effect::kRefused:
      return EventOutcome::kTooFrequent;
    case Effect::kNotPossible:
      return EventOutcome::kNotPossible;
    case Effect::kRepeated:
      return EventOutcome::kRepeated;
    case Effect::kGated:
      return EventOutcome::kGated;
    case Effect::kWithoutOutputs:
    case Effect::kOutputsGated:
      return EventOutcome::kJumpAlone;
    case Effect::kWithdrawn:
      return EventOutcome::kWithdrawn;
    case Effect::kWithdrawal:
      return EventOutcome::kTakenBack;
    case Effect::kNoSuchJump:
      return EventOutcome::kNoSuchJump;
    case Effect::kApplied:
    case Effect::kPastGate:
    case Effect::kRestarted:
      break;
  }
  return report.insertion == Timeline::Insertion::kAppended ? EventOutcome::kUsed
                                                            : EventOutcome::kUsedLate;
}

/// Of a jump that came at `now`.
Event release_of(const Event& jump, Stamp now) {
  Event event;
  event.stamp = std::max(jump.stamp, jump.release > 0 ? jump.release : now);
  event.kind = EventKind::kRelease;
  event.delay = event.stamp - jump.stamp;
  event.index = jump.index;
  event.mode = jump.mode;
  return event;
}

/// @param index  of a jump that was rejected; 0 for other events
Event rejection(EventKind of, std::uint32_t index, Stamp stamp) {
  Event event;
  event.stamp = stamp;
  event.kind = EventKind::kRejected;
  event.rejected = of;
  event.index = index;
  return event;
}

}  // namespace

PublishedBound published_bound(const Estimate& estimate, BoundLoss withheld) {
  const double* state = estimate.state.data();
  const double value = estimate.law->error_bound(state);
  if (withheld != BoundLoss::kNone && std::isfinite(value)) {
    return {std::numeric_limits<double>::infinity(), withheld};
  }
  return {value, estimate.law->bound_loss(state)};
}

void published_state_bounds(const Estimate& estimate, const PublishedBound& bound,
                            double* workspace, Eigen::Ref<Eigen::VectorXd> bounds) {
  if (std::isfinite(bound.value)) {
    estimate.law->state_bounds(estimate.state.data(), workspace, bounds);
  } else {
    bounds.setConstant(bound.value);
  }
}

void EstimateQuery::state_bounds(Eigen::Ref<Eigen::VectorXd> bounds) const {
  Eigen::VectorXd workspace(law_->workspace_size());
  published_state_bounds(estimate_, bound(), workspace.data(), bounds);
}

bool EstimateQuery::proceed(std::int64_t steps) {
  if (!flow_.proceed(steps)) return false;
  estimate_.state = flow_.state();
  estimate_.held = flow_.is_held();
  estimate_.law = law_.get();
  return true;
}

bool is_admissible(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return values.allFinite() &&
         (values.size() == 0 || values.cwiseAbs().maxCoeff() <= kLargestValue);
}

Estimator::Estimator(std::shared_ptr<const ObserverLaw> law, const Options& options)
    : law_(std::move(law)),
      options_(options),
      timeline_(law_, options.history),
      before_restart_(make_estimate()),
      restart_state_(law_->state_size()),
      workspace_(law_->workspace_size()),
      innovation_(law_->max_event_size()),
      is_sampled_(law_->observer().plant().outputs(SensorTiming::kSampled) > 0),
      has_other_events_(law_->observer().plant().inputs() > 0 || law_->observer().plant().jumps()),
      input_unknown_since_(law_->observer().plant().input_channels().size()),
      answer_(make_estimate()) {
  if (!options_.sampling.are_valid()) {
    throw std::invalid_argument("Estimator: 0 <= T1 <= T2 must hold");
  }
  if (options_.future_tolerance < 0) {
    throw std::invalid_argument("Estimator: future_tolerance must not be negative");
  }
  if (options_.latency < 0) {
    throw std::invalid_argument("Estimator: latency must not be negative");
  }
  if (options_.jump_stamp_error < 0) {
    throw std::invalid_argument("Estimator: jump_stamp_error must not be negative");
  }
  if (law_->has_bound()) ellipsoid_.resize(law_->estimate_size(), law_->estimate_size());
  if (options_.start && *options_.start <= 0) {
    throw std::invalid_argument("Estimator: start must be positive");
  }
  clear();
}

std::optional<EventOutcome> Estimator::objection(const Event& event, Stamp now) const {
  if (event.stamp <= 0) return EventOutcome::kNoStamp;
  if (!law_->accepts(event)) return EventOutcome::kWrongSize;
  // Not so for NaN.
  const bool mode_is_admissible = std::abs(event.mode.value_or(0.0)) <= kLargestValue;
  if (!is_admissible(event.vector()) || !mode_is_admissible) return EventOutcome::kNotFinite;
  if (!law_->observer().knows_mode(event)) return EventOutcome::kUnknownMode;
  if (std::max(event.stamp, event.release) - now > options_.future_tolerance) {
    return EventOutcome::kInFuture;
  }
  return std::nullopt;
}

EventReport Estimator::submit(const Event& event, Stamp now) {
  EventReport report;
  if (const std::optional<EventOutcome> outcome = objection(event, now)) {
    report.outcome = *outcome;
    note_rejected(event, now);
    return report;
  }
  if (is_earlier(event.stamp)) return submit_earlier(event, now);
  if (awaits_sample_ && event.kind == EventKind::kSample && event.stamp > *timeline_.earliest()) {
    begin_at(event);
  }
  if (event.kind == EventKind::kSample || event.kind == EventKind::kOutput) {
    look_at_innovation(event, report);
  }
  // Even where the jump has no effect now: whether it has is known for sure only when all events
  // are.
  const bool is_released = event.kind == EventKind::kJump && law_->delays_jumps();
  const Timeline::InsertReport inserted =
      is_released ? timeline_.insert(event, release_of(event, now)) : timeline_.insert(event);
  report.outcome = outcome_of(inserted);
  report.rewound = inserted.rewound;
  report.effect = inserted.effect;
  const bool is_in_log = inserted.insertion == Timeline::Insertion::kAppended ||
                         inserted.insertion == Timeline::Insertion::kRewound;
  // A jump without number that equals one in the log may be another.
  const bool may_be_another = report.outcome == EventOutcome::kDuplicate &&
                              event.kind == EventKind::kJump && event.index == 0 &&
                              law_->lets_jumps_coincide();
  if (report.outcome == EventOutcome::kTooOld || may_be_another) note_rejected(event, now);
  if (is_in_log && event.kind == EventKind::kInput) learn_input(event);
  if (report.used() && inserted.previous) {
    report.interval = event.stamp - *inserted.previous;
    if (event.kind == EventKind::kSample || !is_sampled_) {
      const auto sensor = static_cast<std::size_t>(event.sensor);
      report.interval_check = check(*report.interval, options_.sampling.of(event.kind, sensor));
    }
  }
  if (report.used() && event.kind == EventKind::kJump && law_->watches_dwell_times()) {
    report.dwell_check = dwell_check_at(event.stamp);
  }
  return report;
}

/// Of the newest jump of a stamp.
DwellCheck Estimator::dwell_check_at(Stamp stamp) {
  const Timeline::Query query =
      timeline_.state_at(stamp, before_restart_.state, before_restart_.counts);
  if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) return DwellCheck::kNone;
  return law_->dwell_check(before_restart_.state.data());
}

/// Before it takes effect.
void Estimator::look_at_innovation(const Event& measured, EventReport& report) {
  const Timeline::Query query =
      timeline_.state_at(measured.stamp, before_restart_.state, before_restart_.counts);
  if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) {
    return;
  }
  const double* state = before_restart_.state.data();
  law_->observer().innovation(measured, state, innovation_.data());
  report.innovation = innovation_.head(measured.size).norm();
  report.innovations = innovation_.data();
  report.gate_share = law_->gate_share(measured, state, workspace_.data());
  const double distance = law_->observer().mahalanobis_distance(measured, state, workspace_.data());
  report.nis = distance * distance;
}

void Estimator::note_rejected(const Event& event, Stamp now) {
  // Whose withdrawal was rejected is a jump of the estimate that the plant did not make.
  const EventKind kind = event.kind == EventKind::kWithdrawal ? EventKind::kJump : event.kind;
  if (kind != EventKind::kInput && kind != EventKind::kJump) return;
  const Stamp stamp = event.stamp > 0 ? std::min(event.stamp, now) : now;
  if (stamp <= 0) return;
  if (kind == EventKind::kInput) {
    miss_input(event.sensor, stamp);
  } else if (stamp <= began_at_.value_or(0) && !law_->observer().plant().switches()) {
    return;  // Somebody vouches for what came after this jump, but not for the mode.
  }
  // Whether the law of that time minds is its own matter.
  if (has_earlier() && stamp <= *taken_over_at_) {
    earlier_->note_rejected(event, now);
    mark_what_is_unseen(kind, event.index, stamp);
    go_on_from_earlier();
  } else {
    insert_rejected(kind, event.index, stamp);
  }
}

void Estimator::learn_input(const Event& input) {
  std::optional<Stamp>& unknown_since =
      input_unknown_since_[static_cast<std::size_t>(input.sensor)];
  if (input.stamp > unknown_since.value_or(input.stamp)) unknown_since.reset();
}

void Estimator::miss_input(int channel, Stamp stamp) {
  std::optional<Stamp>& unknown_since = input_unknown_since_[static_cast<std::size_t>(channel)];
  unknown_since = std::max(stamp, unknown_since.value_or(stamp));
}

/// Whether the last input of some channel is not known.
bool Estimator::lacks_an_input() const {
  return std::any_of(input_unknown_since_.begin(), input_unknown_since_.end(),
                     [](const auto& since) { return since.has_value(); });
}

/// Where the law minds.
void Estimator::insert_rejected(EventKind kind, std::uint32_t index, Stamp stamp) {
  if (!law_->accepts(rejection(kind, index, stamp))) return;
  stamp = std::max(stamp, timeline_.earliest_insertion().value_or(stamp));
  timeline_.insert(rejection(kind, index, stamp));
}

Timeline::Query Estimator::estimate_at(Stamp stamp, Estimate& estimate) const {
  if (awaits_sample_) return Timeline::Query::kNoEvent;
  const Estimator& from = at(stamp);
  const Timeline::Query query = from.timeline_.state_at(stamp, estimate.state, estimate.counts);
  estimate.stamp = stamp;
  estimate.held = query == Timeline::Query::kHeld;
  estimate.law = from.law_.get();
  return query;
}

Timeline::Query Estimator::estimate_at(Stamp stamp, const Estimate*& estimate) {
  Estimate& answer = responsible_for(stamp).answer_;
  estimate = &answer;
  return estimate_at(stamp, answer);
}

Timeline::Query Estimator::begin_query(Stamp stamp, Stamp now, EstimateQuery& query) const {
  if (awaits_sample_) return Timeline::Query::kNoEvent;
  const Estimator& from = at(stamp);
  query.law_ = from.law_;
  query.withheld_ = is_before_gap(stamp) ? BoundLoss::kUnknownJump : withheld(stamp, now);
  query.estimate_.stamp = stamp;
  return from.timeline_.begin_flow(stamp, query.flow_, query.estimate_.counts);
}

std::int64_t Estimator::approach(Stamp stamp, std::int64_t steps) const {
  return at(stamp).timeline_.approach(stamp, steps);
}

std::optional<Stamp> Estimator::earliest() const {
  if (awaits_sample_) return std::nullopt;
  return has_earlier() ? earlier_->earliest() : timeline_.earliest();
}

Estimate Estimator::make_estimate() const {
  Estimate estimate;
  estimate.state = Eigen::VectorXd::Zero(law_->state_size());
  estimate.law = law_.get();
  return estimate;
}

/// Sets the state to start from: the configured one, with what is held and the mode of `from` at
/// `stamp`, or where its states begin. Returns whether it has any, and leaves that one in
/// from.before_restart_.
bool Estimator::prepare_restart(Estimator& from, Stamp stamp) {
  law_->initialize(restart_state_.data());
  Estimate& before = from.before_restart_;
  stamp = std::max(stamp, from.timeline_.earliest().value_or(stamp));
  const Timeline::Query query = from.timeline_.state_at(stamp, before.state, before.counts);
  before.held = query == Timeline::Query::kHeld;
  if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) return false;
  const PlantObserver& observer = law_->observer();
  const PlantObserver& previous = from.law_->observer();
  observer.keep_held(previous.held_part(before.state.data()), restart_state_.data());
  observer.keep_mode(from.law_->told_mode(before.state.data()), restart_state_.data());
  if (observer.plant().switches() && from.law_->mode_is_open(before.state.data())) {
    law_->leave_mode_open(restart_state_.data());
  }
  return true;
}

void Estimator::restart(Stamp stamp) {
  prepare_restart(responsible_for(stamp), stamp);
  begin(stamp);
}

void Estimator::restart(Stamp stamp, Timeline::ConstStateRef estimate) {
  prepare_restart(responsible_for(stamp), stamp);
  law_->observer().start_from(estimate.data(), restart_state_.data());
  begin(stamp);
}

void Estimator::begin(Stamp stamp) {
  began_at_ = stamp;
  taken_over_at_.reset();
  timeline_.restart(stamp, restart_state_);
  if (lacks_an_input()) insert_rejected(EventKind::kInput, 0, stamp + 1);
  awaits_sample_ = false;
}

void Estimator::restart_at_next_sample(Stamp stamp) {
  restart(stamp);
  awaits_sample_ = true;
}

/// The sample itself is not part of the start, but the first event after it: so laws that keep
/// track of samples (the time since the last, a held innovation) see it.
void Estimator::begin_at(const Event& sample) {
  const Stamp start = sample.stamp - 1;
  prepare_restart(*this, start);
  law_->observer().fit_to(sample, restart_state_.data(), workspace_.data());
  began_at_ = start;
  taken_over_at_.reset();
  timeline_.rebase(start, restart_state_);
  if (lacks_an_input()) insert_rejected(EventKind::kInput, 0, sample.stamp);
  awaits_sample_ = false;
}

void Estimator::resume(Stamp stamp) {
  if (has_earlier()) stamp = std::max(stamp, *taken_over_at_);
  const Timeline::Query query = timeline_.state_at(stamp, restart_state_, before_restart_.counts);
  if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) return;
  taken_over_at_.reset();
  timeline_.rebase(stamp, restart_state_, query == Timeline::Query::kHeld);
}

void Estimator::clear() {
  timeline_.clear();
  if (options_.start) timeline_.begin(*options_.start);
  std::fill(input_unknown_since_.begin(), input_unknown_since_.end(), std::nullopt);
  began_at_.reset();
  // A jump of that stamp comes after the start.
  if (options_.start) began_at_ = *options_.start - 1;
  taken_over_at_.reset();
  awaits_sample_ = false;
}

}  // namespace sampled_data_observers
