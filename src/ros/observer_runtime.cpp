#include "sampled_data_observers/ros/observer_runtime.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sampled_data_observers/ros/time_conversion.h"

namespace sampled_data_observers {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

static_assert(EventStatus::INPUT == static_cast<int>(EventKind::kInput));
static_assert(EventStatus::JUMP_OUTPUT == static_cast<int>(EventKind::kJumpOutput));
static_assert(EventStatus::OUTPUT == static_cast<int>(EventKind::kOutput));
static_assert(EventStatus::JUMP == static_cast<int>(EventKind::kJump));
static_assert(EventStatus::SAMPLE == static_cast<int>(EventKind::kSample));
static_assert(EventStatus::USED == static_cast<int>(EventOutcome::kUsed));
static_assert(EventStatus::USED_LATE == static_cast<int>(EventOutcome::kUsedLate));
static_assert(EventStatus::DUPLICATE == static_cast<int>(EventOutcome::kDuplicate));
static_assert(EventStatus::TOO_OLD == static_cast<int>(EventOutcome::kTooOld));
static_assert(EventStatus::IN_FUTURE == static_cast<int>(EventOutcome::kInFuture));
static_assert(EventStatus::NO_STAMP == static_cast<int>(EventOutcome::kNoStamp));
static_assert(EventStatus::WRONG_SIZE == static_cast<int>(EventOutcome::kWrongSize));
static_assert(EventStatus::NOT_FINITE == static_cast<int>(EventOutcome::kNotFinite));
static_assert(EventStatus::WOULD_OVERFLOW == static_cast<int>(EventOutcome::kWouldOverflow));
static_assert(EventStatus::UNKNOWN_MODE == static_cast<int>(EventOutcome::kUnknownMode));
static_assert(EventStatus::TOO_FREQUENT == static_cast<int>(EventOutcome::kTooFrequent));
static_assert(EventStatus::GATED == static_cast<int>(EventOutcome::kGated));
static_assert(EventStatus::DISABLED == static_cast<int>(EventOutcome::kDisabled));
static_assert(EventStatus::NO_TRANSFORM == static_cast<int>(EventOutcome::kNoTransform));
static_assert(EventStatus::NO_FIELD == static_cast<int>(EventOutcome::kNoField));
static_assert(EventStatus::OUT_OF_ORDER == static_cast<int>(EventOutcome::kOutOfOrder));
static_assert(EventStatus::INTERVAL_NONE == static_cast<int>(IntervalCheck::kNone));
static_assert(EventStatus::INTERVAL_WITHIN == static_cast<int>(IntervalCheck::kWithin));
static_assert(EventStatus::INTERVAL_SHORT == static_cast<int>(IntervalCheck::kShort));
static_assert(EventStatus::INTERVAL_LONG == static_cast<int>(IntervalCheck::kLong));

const char* describe(const EventReport& report) {
  switch (report.effect) {
    case Effect::kPastGate:
      return "used though outside the gate: all were for recovery/after";
    case Effect::kRestarted:
      return "used after a reset: all were outside for recovery/after";
    default:
      break;
  }
  switch (report.outcome) {
    case EventOutcome::kUsed:
      return "used";
    case EventOutcome::kUsedLate:
      return "used late";
    case EventOutcome::kDuplicate:
      return "duplicate of an event taken in before";
    case EventOutcome::kTooOld:
      return "older than the history window, the start or the last reset";
    case EventOutcome::kInFuture:
      return "stamped in the future";
    case EventOutcome::kNoStamp:
      return "stamp is zero or invalid";
    case EventOutcome::kWrongSize:
      return "wrong number of values";
    case EventOutcome::kNotFinite:
      return "a value is not finite, or beyond 1e100";
    case EventOutcome::kWouldOverflow:
      return "the estimate would overflow";
    case EventOutcome::kUnknownMode:
      return "a mode that the plant does not have";
    case EventOutcome::kTooFrequent:
      return "jumps faster than jumps/min_separation or max_per_second allow";
    case EventOutcome::kGated:
      return "the innovation lies outside the gate";
    case EventOutcome::kDisabled:
      return "the observer or the sensor is switched off";
    case EventOutcome::kNoTransform:
      return "no transform into the configured frame came in time";
    case EventOutcome::kNoField:
      return "the message does not hold a configured field";
    case EventOutcome::kOutOfOrder:
      return "a detector's signal, stamped not after the one before";
  }
  return "";
}

EventKind kind_of(SensorTiming timing) {
  switch (timing) {
    case SensorTiming::kSampled:
      return EventKind::kSample;
    case SensorTiming::kContinuous:
      return EventKind::kOutput;
    case SensorTiming::kAtJumps:
      break;
  }
  return EventKind::kJumpOutput;
}

std::vector<EventChannel> event_channels(const ObserverConfig& config) {
  std::vector<EventChannel> channels;
  for (std::size_t i = 0; i < config.sensors.size(); ++i) {
    if (!config.sensors[i]) continue;
    const Sensor& sensor = config.plant->sensors()[i];
    channels.push_back(
        {kind_of(sensor.timing), static_cast<int>(i), sensor.name, *config.sensors[i]});
  }
  if (config.input) channels.push_back({EventKind::kInput, 0, "input", *config.input});
  if (config.jumps) channels.push_back({EventKind::kJump, 0, "jumps", *config.jumps});
  for (std::size_t i = 0; i < channels.size(); ++i) channels[i].index = i;
  return channels;
}

bool has_frames(const ObserverConfig& config) {
  const std::vector<EventChannel> channels = event_channels(config);
  return std::any_of(channels.begin(), channels.end(),
                     [](const EventChannel& channel) { return channel.source.frames.any(); });
}

ObserverRuntime::ObserverRuntime(const ObserverConfig& config)
    : config_(config),
      estimator_(config.law, config.options),
      grid_(config.period, config.publish_delay, config.options.history.history),
      estimate_(estimator_.make_estimate()),
      sensors_enabled_(config.sensors.size(), true),
      watches_(config.sensors.size()) {}

bool ObserverRuntime::is_enabled(const EventChannel& channel) const {
  if (channel.kind == EventKind::kInput || channel.kind == EventKind::kJump) return enabled_;
  return enabled_ && sensors_enabled_[static_cast<std::size_t>(channel.channel)];
}

EventReport ObserverRuntime::receive(const EventChannel& channel, const Event& event, Stamp now,
                                     EventStatus& status) {
  now_ = now;
  EventReport report;
  if (is_enabled(channel)) {
    report = estimator_.submit(event, now);
    watch_innovation(event, report);
  } else {
    report.outcome = EventOutcome::kDisabled;
    estimator_.note_rejected(event, now);
  }
  report.came_after_bound = comes_after_bound(event, report);
  if (config_.publish_on_event && report.used()) event_waits_ = true;
  write(channel, event, report, now, status);
  return report;
}

/// The plant had it, whatever became of it here. At its own stamp an input changes nothing yet, as
/// a jump does.
bool ObserverRuntime::comes_after_bound(const Event& event, const EventReport& report) const {
  const bool is_of_plant = event.kind == EventKind::kInput || event.kind == EventKind::kJump;
  return is_of_plant && report.outcome != EventOutcome::kDuplicate && event.stamp > 0 &&
         (event.kind == EventKind::kInput ? event.stamp < bounded_until_
                                          : event.stamp <= bounded_until_);
}

/// A sample that a gate keeps out says as much of the estimate as one that is used.
void ObserverRuntime::watch_innovation(const Event& event, EventReport& report) {
  const bool counts = report.used() || report.outcome == EventOutcome::kGated;
  if (!counts || std::isnan(report.innovation)) return;
  InnovationWatch& watch = watches_[static_cast<std::size_t>(event.channel)];
  report.trend = watch.add(report.innovation, event.vector().norm());
}

void ObserverRuntime::forget_innovations() {
  std::fill(watches_.begin(), watches_.end(), InnovationWatch());
}

EventReport ObserverRuntime::reject(const EventChannel& channel, const Event& event,
                                    EventOutcome outcome, const std::string& detail, Stamp now,
                                    EventStatus& status) {
  now_ = now;
  estimator_.note_rejected(event, now);
  EventReport report;
  report.outcome = outcome;
  report.came_after_bound = comes_after_bound(event, report);
  write(channel, event, report, now, status);
  if (!detail.empty()) status.reason.append(": ").append(detail);
  return report;
}

void ObserverRuntime::write(const EventChannel& channel, const Event& event,
                            const EventReport& report, Stamp now, EventStatus& status) {
  status.header.stamp = to_ros_time(event.stamp);
  status.source = channel.name;
  status.kind = static_cast<std::uint8_t>(event.kind);
  status.outcome = static_cast<std::uint8_t>(report.outcome);
  status.reason = describe(report);
  status.latency = to_seconds(now - event.stamp);
  status.rewound = static_cast<std::uint32_t>(report.rewound);
  status.interval = report.interval ? to_seconds(*report.interval) : kNone;
  status.interval_check = static_cast<std::uint8_t>(report.interval_check);
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
  switch (estimator_.estimate_at(*stamp, estimate_)) {
    case Timeline::Query::kOk:
    case Timeline::Query::kHeld:
      if (std::isfinite(bound(estimate_).value)) {
        bounded_until_ = std::max(bounded_until_, *stamp);
      }
      return &estimate_;
    default:
      return nullptr;
  }
}

const Estimate* ObserverRuntime::estimate_at(Stamp stamp, std::string& reason) {
  if (!enabled_ || estimator_.awaits_sample()) {
    reason = enabled_ ? "the estimate begins with the next sample" : "the observer is switched off";
    return nullptr;
  }
  switch (estimator_.estimate_at(stamp, estimate_)) {
    case Timeline::Query::kOk:
    case Timeline::Query::kHeld:
      return &estimate_;
    case Timeline::Query::kNoEvent:
      reason = "no event was received yet";
      break;
    case Timeline::Query::kBeforeStart:
      reason = "the stamp is before the first event or the last reset";
      break;
    case Timeline::Query::kBeforeWindow:
      reason = "the stamp is before the history window (see history/duration and max_events)";
      break;
  }
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
  if (config_.plant->outputs(SensorTiming::kSampled) == 0) {
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
    if (!config_.sensors[i]) continue;
    const std::string& sensor = config_.plant->sensors()[i].name;
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

void ObserverRuntime::write(const Estimate& estimate, StateEstimate& message) const {
  const Eigen::Index size = estimator_.law().estimate_size();
  message.header.stamp = to_ros_time(estimate.stamp);
  message.header.frame_id = config_.frame_id;
  message.names = estimator_.law().estimate_names();
  message.state.assign(estimate.state.data(), estimate.state.data() + size);
  const double* covariance = estimator_.law().covariance(estimate.state.data());
  if (covariance != nullptr) message.covariance.assign(covariance, covariance + size * size);
  message.error_bound = bound(estimate).value;
  message.time_since_sample = estimate.counts.last_sample
                                  ? to_seconds(estimate.stamp - *estimate.counts.last_sample)
                                  : kNone;
  message.events = estimate.counts.events;
  message.samples = estimate.counts.samples;
  message.jumps = estimate.counts.jumps;
  message.held = estimate.held ? 1 : 0;
}

}  // namespace sampled_data_observers
