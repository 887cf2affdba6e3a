#include "sampled_data_observers/runtime/observer_runtime.h"

#include <algorithm>
#include <cmath>

namespace sampled_data_observers {
namespace {

/// Null where there is an estimate.
const char* describe_failure(Timeline::Query query) {
  switch (query) {
    case Timeline::Query::kNoEvent:
      return "no event was received yet";
    case Timeline::Query::kBeforeStart:
      return "the stamp is before the first event or the last reset";
    case Timeline::Query::kBeforeWindow:
      return "the stamp is before the history window (see history/duration and max_events)";
    case Timeline::Query::kOk:
    case Timeline::Query::kHeld:
      break;
  }
  return nullptr;
}

/// And not of a sensor.
bool is_of_plant(const Event& event) {
  return event.kind == EventKind::kInput || event.kind == EventKind::kJump ||
         event.kind == EventKind::kWithdrawal;
}

}  // namespace

ObserverRuntime::ObserverRuntime(const RuntimeSetup& setup)
    : setup_(setup),
      estimator_(setup.law, setup.options),
      grid_(setup.period, setup.publish_delay, setup.options.history.history),
      sensors_enabled_(setup.has_topic.size(), true),
      watches_(setup.has_topic.size()) {}

bool ObserverRuntime::is_enabled(const Event& event) const {
  if (is_of_plant(event)) return enabled_;
  return enabled_ && sensors_enabled_[static_cast<std::size_t>(event.sensor)];
}

EventReport ObserverRuntime::receive(const Event& event, Stamp now) {
  now_ = now;
  const bool had_gap = is_bound_before_gap(event);
  EventReport report;
  if (is_enabled(event)) {
    report = estimator_.submit(event, now);
    watch_innovation(event, report);
  } else {
    report.outcome = EventOutcome::kDisabled;
    estimator_.note_rejected(event, now);
  }
  report.came_after_bound =
      comes_after_bound(event, report) || (!had_gap && is_bound_before_gap(event));
  if (setup_.publish_on_event && report.used()) event_waits_ = true;
  return report;
}

/// The plant had it, whatever became of it here. At its own stamp an input changes nothing yet, as
/// a jump does, which may even have been before it.
bool ObserverRuntime::comes_after_bound(const Event& event, const EventReport& report) const {
  const Duration jump_stamp_error = setup_.options.jump_stamp_error;
  const bool changes_nothing = report.outcome == EventOutcome::kDuplicate ||
                               report.outcome == EventOutcome::kWithdrawn ||
                               report.outcome == EventOutcome::kNoSuchJump;
  return is_of_plant(event) && bounded_until_ > 0 && !changes_nothing && event.stamp > 0 &&
         (event.kind == EventKind::kInput ? event.stamp < bounded_until_
                                          : event.stamp <= bounded_until_ + jump_stamp_error);
}

/// Whether the newest finite bound may be one of a run without a jump that was lost, as far as
/// numbers of later jumps tell: a matter of events with a number only.
bool ObserverRuntime::is_bound_before_gap(const Event& event) const {
  return is_of_plant(event) && event.index != 0 && bounded_until_ > 0 &&
         estimator_.is_before_gap(bounded_until_);
}

/// A sample that a gate keeps out says as much of the estimate as one that is used.
void ObserverRuntime::watch_innovation(const Event& event, EventReport& report) {
  const bool counts = report.used() || report.outcome == EventOutcome::kGated;
  if (!counts || std::isnan(report.innovation)) return;
  InnovationWatch& watch = watches_[static_cast<std::size_t>(event.sensor)];
  report.trend = watch.add(report.innovation, event.vector().norm());
}

void ObserverRuntime::forget_innovations() {
  std::fill(watches_.begin(), watches_.end(), InnovationWatch());
}

EventReport ObserverRuntime::reject(const Event& event, EventOutcome outcome, Stamp now) {
  now_ = now;
  estimator_.note_rejected(event, now);
  EventReport report;
  report.outcome = outcome;
  report.came_after_bound = comes_after_bound(event, report);
  return report;
}

const Estimate* ObserverRuntime::next_due(Stamp now) {
  now_ = now;
  const std::optional<Stamp> earliest = estimator_.earliest();
  if (!enabled_ || !earliest) return nullptr;
  std::optional<Stamp> stamp = grid_.next(now, *earliest);
  if (!stamp) {
    const bool at_once = event_waits_ && *earliest <= now && grid_.insert(now);
    event_waits_ = false;
    if (!at_once) return nullptr;
    stamp = now;
  }
  const Estimate* estimate = nullptr;
  switch (estimator_.estimate_at(*stamp, estimate)) {
    case Timeline::Query::kOk:
    case Timeline::Query::kHeld:
      if (std::isfinite(bound(*estimate).value)) {
        bounded_until_ = std::max(bounded_until_, *stamp);
      }
      return estimate;
    default:
      return nullptr;
  }
}

bool ObserverRuntime::is_due(Stamp now) const {
  const std::optional<Stamp> earliest = estimator_.earliest();
  return enabled_ && earliest && (event_waits_ || grid_.peek(now, *earliest));
}

std::int64_t ObserverRuntime::approach_next_due(Stamp now, std::int64_t steps) const {
  const std::optional<Stamp> earliest = estimator_.earliest();
  if (!enabled_ || !earliest) return 0;
  std::optional<Stamp> stamp = grid_.peek(now, *earliest);
  if (!stamp && event_waits_) stamp = now;
  return stamp ? estimator_.approach(*stamp, steps) : 0;
}

std::int64_t ObserverRuntime::approach(const Event& event, Stamp now, std::int64_t steps) const {
  const bool is_in_future = event.stamp - now > setup_.options.future_tolerance;
  return is_in_future ? 0 : estimator_.approach(event.stamp, steps);
}

const Estimate* ObserverRuntime::estimate_at(Stamp stamp, std::string& reason) {
  const Estimate* estimate = nullptr;
  const char* objection = objection_to_queries();
  if (objection == nullptr) {
    objection = describe_failure(estimator_.estimate_at(stamp, estimate));
  }
  if (objection == nullptr) return estimate;
  reason = objection;
  return nullptr;
}

const char* ObserverRuntime::begin_query(Stamp stamp, Stamp now, EstimateQuery& query) const {
  const char* objection = objection_to_queries();
  if (objection != nullptr) return objection;
  return describe_failure(estimator_.begin_query(stamp, now, query));
}

/// Null where there is none.
const char* ObserverRuntime::objection_to_queries() const {
  if (!enabled_) return "the observer is switched off";
  if (estimator_.awaits_sample()) return "the estimate begins with the next sample";
  return nullptr;
}

std::string ObserverRuntime::restart(Stamp now, const std::vector<double>& estimate) {
  const Eigen::Map<const Eigen::VectorXd> values(estimate.data(),
                                                 static_cast<Eigen::Index>(estimate.size()));
  const Eigen::Index expected = estimator_.law().estimate_size();
  if (!estimate.empty() && values.size() != expected) {
    return "expected " + std::to_string(expected) + " values or none, found " +
           std::to_string(estimate.size());
  }
  if (!is_admissible(values)) return "expected finite values up to 1e100, found another";
  if (estimate.empty()) {
    estimator_.restart(now);
  } else {
    estimator_.restart(now, values);
  }
  forget_innovations();
  grid_.restart(now);
  return "";
}

std::string ObserverRuntime::restart_at_next_sample(Stamp now) {
  if (setup_.plant->outputs(SensorTiming::kSampled) == 0) {
    return "expected a plant with a sensor that is sampled, found none";
  }
  estimator_.restart_at_next_sample(now);
  forget_innovations();
  grid_.restart(now);
  return "";
}

void ObserverRuntime::start_anew(Stamp now) {
  estimator_.clear();
  bounded_until_ = 0;
  forget_innovations();
  grid_.restart(now);
}

void ObserverRuntime::set_enabled(bool enabled, Stamp now) {
  if (enabled && !enabled_) {
    estimator_.resume(now);
    grid_.skip_to(now);
  }
  enabled_ = enabled;
}

std::string ObserverRuntime::enable_sensor(const std::string& name, bool enabled) {
  std::string known;
  for (std::size_t i = 0; i < sensors_enabled_.size(); ++i) {
    if (!setup_.has_topic[i]) continue;
    const std::string& sensor = setup_.plant->sensors()[i].name;
    known += (known.empty() ? "" : ", ") + sensor;
    if (sensor != name) continue;
    sensors_enabled_[i] = enabled;
    return "";
  }
  return "expected a sensor with a topic of its own (" + known + "), found '" + name + "'";
}

void ObserverRuntime::take_over(ObserverRuntime& other, Stamp now) {
  estimator_.take_over(other.estimator_, now);
  grid_ = other.grid_;
  bounded_until_ = other.bounded_until_;
  enabled_ = other.enabled_;
  sensors_enabled_ = other.sensors_enabled_;
  event_waits_ = other.event_waits_;
}

}  // namespace sampled_data_observers
