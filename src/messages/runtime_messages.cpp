#include "messages/runtime_messages.h"

#include <limits>

#include "messages/time_conversion.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// All but the bounds on its entries, for which there is room afterwards.
void write_estimate(const Estimate& estimate, const PublishedBound& bound,
                    const std::string& frame_id, StateEstimate& message) {
  const ObserverLaw& law = *estimate.law;
  const Eigen::Index size = law.estimate_size();
  message.header.stamp = to_ros_time(estimate.stamp);
  message.header.frame_id = frame_id;
  message.names = law.estimate_names();
  message.state.assign(estimate.state.data(), estimate.state.data() + size);
  const double* covariance = law.observer().covariance(estimate.state.data());
  if (covariance != nullptr) message.covariance.assign(covariance, covariance + size * size);
  message.error_bound = bound.value;
  message.error_bounds.resize(law.has_bound() ? static_cast<std::size_t>(size) : 0);
  message.time_since_sample = estimate.counts.last_sample
                                  ? to_seconds(estimate.stamp - *estimate.counts.last_sample)
                                  : kNone;
  message.events = estimate.counts.events;
  message.events_digest = estimate.counts.digest;
  message.samples = estimate.counts.samples;
  message.jumps = estimate.counts.jumps;
  const double* whole = estimate.state.data();
  message.missing_jumps = static_cast<std::uint64_t>(law.missing_jumps(whole));
  message.skipped_jumps = static_cast<std::uint64_t>(law.skipped_jumps(whole));
  message.dwell_violations = static_cast<std::uint64_t>(law.dwell_violations(whole));
  message.at_rest = law.is_at_rest(whole) ? 1 : 0;
  message.held = estimate.held ? 1 : 0;
  message.input_stale = law.observer().is_input_stale(whole) ? 1 : 0;
}

/// Whether the values of an event are those that a sensor measured: what was rejected may have
/// none.
bool has_values(const Event& event, EventOutcome outcome) {
  const bool is_measured = event.kind == EventKind::kSample || event.kind == EventKind::kOutput ||
                           event.kind == EventKind::kJumpOutput;
  return is_measured && (outcome == EventOutcome::kUsed || outcome == EventOutcome::kUsedLate ||
                         outcome == EventOutcome::kGated);
}

Eigen::Map<Eigen::VectorXd> state_bounds_of(StateEstimate& message) {
  return {message.error_bounds.data(), static_cast<Eigen::Index>(message.error_bounds.size())};
}

}  // namespace

static_assert(EventStatus::INPUT == static_cast<int>(EventKind::kInput));
static_assert(EventStatus::JUMP_OUTPUT == static_cast<int>(EventKind::kJumpOutput));
static_assert(EventStatus::OUTPUT == static_cast<int>(EventKind::kOutput));
static_assert(EventStatus::JUMP == static_cast<int>(EventKind::kJump));
static_assert(EventStatus::SAMPLE == static_cast<int>(EventKind::kSample));
static_assert(EventStatus::WITHDRAWAL == static_cast<int>(EventKind::kWithdrawal));
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
static_assert(EventStatus::DROPPED == static_cast<int>(EventOutcome::kDropped));
static_assert(EventStatus::NOT_POSSIBLE == static_cast<int>(EventOutcome::kNotPossible));
static_assert(EventStatus::REPEATED == static_cast<int>(EventOutcome::kRepeated));
static_assert(EventStatus::JUMP_ALONE == static_cast<int>(EventOutcome::kJumpAlone));
static_assert(EventStatus::TAKEN_BACK == static_cast<int>(EventOutcome::kTakenBack));
static_assert(EventStatus::WITHDRAWN == static_cast<int>(EventOutcome::kWithdrawn));
static_assert(EventStatus::NO_SUCH_JUMP == static_cast<int>(EventOutcome::kNoSuchJump));
static_assert(EventStatus::OUT_OF_LIMITS == static_cast<int>(EventOutcome::kOutOfLimits));
static_assert(EventStatus::NO_COVARIANCE == static_cast<int>(EventOutcome::kNoCovariance));
static_assert(EventStatus::DWELL_NONE == static_cast<int>(DwellCheck::kNone));
static_assert(EventStatus::DWELL_WITHIN == static_cast<int>(DwellCheck::kWithin));
static_assert(EventStatus::DWELL_SHORT == static_cast<int>(DwellCheck::kShort));
static_assert(EventStatus::DWELL_LONG == static_cast<int>(DwellCheck::kLong));
static_assert(EventStatus::DWELL_MANY == static_cast<int>(DwellCheck::kMany));
static_assert(EventStatus::DWELL_FEW == static_cast<int>(DwellCheck::kFew));
static_assert(EventStatus::OTHER_DEFINITION == static_cast<int>(EventOutcome::kOtherDefinition));
static_assert(EventStatus::MALFORMED == static_cast<int>(EventOutcome::kMalformed));
static_assert(EventStatus::INTERVAL_NONE == static_cast<int>(IntervalCheck::kNone));
static_assert(EventStatus::INTERVAL_WITHIN == static_cast<int>(IntervalCheck::kWithin));
static_assert(EventStatus::INTERVAL_SHORT == static_cast<int>(IntervalCheck::kShort));
static_assert(EventStatus::INTERVAL_LONG == static_cast<int>(IntervalCheck::kLong));

void write(const EventChannel& channel, const Event& event, const EventReport& report,
           const std::string& detail, Stamp now, EventStatus& status) {
  status.header.stamp = to_ros_time(event.stamp);
  status.source = channel.name;
  status.kind = static_cast<std::uint8_t>(event.kind);
  status.outcome = static_cast<std::uint8_t>(report.outcome);
  status.reason = describe(report);
  if (!detail.empty()) status.reason.append(": ").append(detail);
  status.latency = to_seconds(now - event.stamp);
  status.rewound = static_cast<std::uint32_t>(report.rewound);
  status.interval = report.interval ? to_seconds(*report.interval) : kNone;
  status.interval_check = static_cast<std::uint8_t>(report.interval_check);
  status.dwell_check = static_cast<std::uint8_t>(report.dwell_check);
  const Eigen::Index values = has_values(event, report.outcome) ? event.size : 0;
  status.values.assign(event.values, event.values + values);
  const Eigen::Index innovations = report.innovations == nullptr ? 0 : event.size;
  status.innovation.assign(report.innovations, report.innovations + innovations);
  status.gate_share = report.gate_share;
  status.nis = report.nis;
}

void write(ObserverRuntime& runtime, const Estimate& estimate, StateEstimate& message) {
  write_estimate(estimate, runtime.bound(estimate), runtime.setup().frame_id, message);
  if (estimate.law->has_bound()) runtime.state_bounds(estimate, state_bounds_of(message));
}

void write(const EstimateQuery& query, const std::string& frame_id, StateEstimate& message) {
  write_estimate(query.estimate(), query.bound(), frame_id, message);
  if (query.estimate().law->has_bound()) query.state_bounds(state_bounds_of(message));
}

}  // namespace sampled_data_observers
