#include "replay/replay_run.h"

#include <ros/names.h>

#include <algorithm>
#include <cmath>

#include "messages/runtime_messages.h"
#include "messages/time_conversion.h"
#include "replay/thinning.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

/// A gap longer than this is a clock that was set, not a robot that waited.
constexpr Duration kClockJump = Duration{24} * 3600 * kNanosecondsPerSecond;

std::string resolved(const char* name) { return ros::names::resolve(name); }

}  // namespace

ReplayRun::ReplayRun(const ObserverConfig& config, const ReplayOptions& options,
                     const MessageStream& messages, const MessageStream::SampleStamps& stamps,
                     RunRecord* record)
    : config_(config),
      options_(options),
      runtime_(config),
      transforms_(std::make_shared<TransformBuffer>(config.static_transforms, config.navsat)),
      channels_(messages.channels_with(transforms_)),
      truth_(truth_of(config, options, messages.bags(), channels_, transforms_)) {
  for (const BagChannel& bound : channels_) {
    intakes_.emplace_back(
        bound.channel, bound.source,
        [this](const EventChannel& channel, const Event& event, Reading reading,
               const std::string& missing) { return handle(channel, event, reading, missing); });
  }
  comparison_.emplace(truth_.quantities, config.plant);
  tell_jumps_apart();
  choose_samples(stamps);
  recorder_.emplace(config);
  if (record != nullptr) run_.emplace(config, truth_.quantities, *record);
  for (const BagChannel& bound : channels_) {
    if (!bound.is_recorded) recorder_->add_missing_topic(bound.channel.name, bound.topic);
  }
  truth_estimate_ = runtime_.estimator().make_estimate();
  if (!options.output.empty()) output_.emplace(options.output);
}

void ReplayRun::take(const RecordedMessage& message) {
  const Stamp now = message.time;
  publish_due(now);
  bool received = message.transforms != nullptr;
  if (received) transforms_->take(*message.transforms, message.are_static, now);
  for (EventIntake& intake : intakes_) intake.retry(now);
  for (const RecordedMessage::OfChannel& part : message.of_channels) {
    const std::size_t i = part.channel;
    if (is_thinned(options_, channels_[i].channel) && !kept_[i][next_[i]++]) {
      recorder_->add_withheld_sample();
      continue;
    }
    received = true;
    take_part(part, now);
  }
  if (received) publish_due_at(now);
  if (received && output_) {
    const rosbag::MessageInstance& instance = message.instance;
    output_->write(instance.getTopic(), instance.getTime(), instance,
                   instance.getConnectionHeader());
  }
  compare_waiting(now);
  if (message.truth) {
    take_truth(message.truth->stamp, message.truth->values);
  } else if (message.unread_truth) {
    Stamp stamp = 0;
    if (truth_.read(message.unread_truth, now, stamp, truth_values_)) {
      take_truth(stamp, truth_values_);
    }
  }
}

void ReplayRun::take_part(const RecordedMessage::OfChannel& part, Stamp now) {
  if (!part.reading) {
    intakes_[part.channel].take(part.content, now, now);
  } else if (*part.reading != Reading::kPassedOver) {
    Event event = part.event;
    event.values = part.values.data();
    const BagChannel& bound = channels_[part.channel];
    const bool is_other = *part.reading == Reading::kOtherDefinition;
    handle(bound.channel, event, *part.reading,
           is_other ? bound.source->describe_sender(part.content) : "");
  }
}

ReplaySummary ReplayRun::finish(const MessageStream& messages) {
  // The clock of a live run would go on to the end of the bag, and estimates wait for their delay.
  if (clock_) publish_due(messages.end() + std::max(config_.publish_delay, settling_time()));
  if (clock_) compare_waiting(*clock_);
  for (EventIntake& intake : intakes_) intake.give_up();
  if (output_) output_->finish();

  ReplaySummary summary = recorder_->summary();
  summary.bag = name_of(options_.bags);
  summary.observer = config_.type;
  summary.datum = transforms_->datum_text();
  summary.bag_seconds = messages.seconds();
  summarize(summary);
  return summary;
}

void ReplayRun::tell_jumps_apart() {
  const Duration stamp_error = config_.options.jump_stamp_error;
  const bool is_wanted = options_.around_jumps || stamp_error > 0;
  if (!is_wanted || truth_.quantities.empty() || !config_.plant->jumps()) return;
  const Duration around =
      options_.around_jumps ? from_seconds(*options_.around_jumps) : stamp_error;
  neighbourhood_.emplace(truth_.quantities, config_.plant, around);
}

/// Those that the seed keeps.
void ReplayRun::choose_samples(const MessageStream::SampleStamps& stamps) {
  kept_.resize(channels_.size());
  next_.resize(channels_.size(), 0);
  if (!options_.thinning) return;
  const ReplayOptions::Thinning& thinning = *options_.thinning;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (!is_thinned(options_, channels_[i].channel)) continue;
    const SamplingBounds times = thinning.times ? *thinning.times : times_to_thin_to(i);
    kept_[i] = thin_among(stamps[i], times.T1, times.T2,
                          thinning.seed + (thinning.times ? first_on_topic(i) : i));
  }
}

SamplingBounds ReplayRun::times_to_thin_to(std::size_t channel) const {
  const EventChannel& own = channels_[channel].channel;
  const SamplingBounds& times =
      config_.options.sampling.of_sensor(static_cast<std::size_t>(own.sensor));
  if (times.T1 > 0 && times.T2 < kNoLongestTime) return times;
  throw ReplayError("--thin-to-sampling: expected T1 > 0 and a T2 in the sampling of " + own.name +
                    ", found " + (times.T1 > 0 ? "no longest time" : "T1 = 0"));
}

/// Sensors that share a topic share its seed, so that they keep the same messages.
std::size_t ReplayRun::first_on_topic(std::size_t channel) const {
  std::size_t first = 0;
  while (channels_[first].topic != channels_[channel].topic) ++first;
  return first;
}

bool ReplayRun::handle(const EventChannel& channel, const Event& event, Reading reading,
                       const std::string& missing) {
  const EventReport report = reading == Reading::kEvent
                                 ? runtime_.receive(event, *clock_)
                                 : runtime_.reject(event, outcome_of(reading), *clock_);
  write(channel, event, report, missing, *clock_, status_);
  if (output_) output_->write(resolved("events"), to_ros_time(*clock_), status_);
  recorder_->add_event(channel, event, report, status_.reason, *clock_ - event.stamp);
  if (run_) run_->add_event(event, report, status_, *clock_);
  const bool is_measurement = event.kind == EventKind::kSample || event.kind == EventKind::kOutput;
  if (neighbourhood_ && report.used() && event.kind == EventKind::kJump) {
    const Stamp release = event.release > 0 ? event.release : *clock_;
    neighbourhood_->add_jump(
        event.stamp, config_.law->delays_jumps() ? std::max(event.stamp, release) : event.stamp);
  }
  if (neighbourhood_ && report.outcome == EventOutcome::kTakenBack) {
    neighbourhood_->remove_jump(event.stamp);
  }
  if (report.used() && is_measurement) {
    const auto sensor = static_cast<std::size_t>(event.sensor);
    comparison_->add_sample(sensor, event.stamp, event.values);
  }
  return is_good(report.outcome);
}

/// Lets time pass as a live observer would see it: from one due estimate to the next, however
/// long no message came.
void ReplayRun::publish_due(Stamp now) {
  if (clock_ && now - *clock_ < kClockJump) {
    for (Stamp due = runtime_.next_due_time(*clock_); due < now;
         due = runtime_.next_due_time(due)) {
      publish_due_at(due);
    }
  }
  publish_due_at(now);
  clock_ = now;
}

void ReplayRun::publish_due_at(Stamp now) {
  while (const Estimate* estimate = runtime_.next_due(now)) {
    write(runtime_, *estimate, estimate_message_);
    final_is_held_ = estimate->held;
    recorder_->add_estimate(*estimate, runtime_.bound(*estimate).loss);
    if (run_) run_->add_estimate(*estimate, estimate_message_);
    if (output_) {
      output_->write(resolved("estimate"), to_ros_time(estimate->stamp + config_.publish_delay),
                     estimate_message_);
    }
  }
}

void ReplayRun::take_truth(Stamp stamp, const std::vector<double>& values) {
  if (!std::all_of(values.begin(), values.end(),
                   [](double value) { return std::isfinite(value); })) {
    return;
  }
  if (!first_truth_) first_truth_ = stamp;
  const double elapsed = to_seconds(stamp - *first_truth_);
  const bool is_counted = elapsed >= options_.from && elapsed <= options_.to;
  if (!is_counted && !run_) return;
  if (settling_time() == 0) {
    compare({stamp, values, is_counted});
  } else {
    waiting_truth_.push_back({stamp, values, is_counted});
  }
}

/// How long after a stamp its bound is known [ns].
Duration ReplayRun::settling_time() const {
  return config_.options.latency + config_.options.jump_stamp_error;
}

/// Compares what had to wait until no more events can come before its stamp.
void ReplayRun::compare_waiting(Stamp now) {
  while (!waiting_truth_.empty() && now - waiting_truth_.front().stamp >= settling_time()) {
    compare(waiting_truth_.front());
    waiting_truth_.pop_front();
  }
}

void ReplayRun::compare(const TruthAt& truth) {
  const Timeline::Query query = runtime_.estimator().estimate_at(truth.stamp, truth_estimate_);
  if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) return;
  const double* state = truth_estimate_.state.data();
  Comparison::Bounds bounds{runtime_.bound(truth_estimate_).value};
  if (truth_estimate_.law->has_bound()) {
    bounds.states.resize(truth_estimate_.law->estimate_size());
    runtime_.state_bounds(truth_estimate_, bounds.states);
  }
  const bool is_compared = truth.is_counted && comparison_->add_truth(truth.values, state, bounds);
  if (run_) {
    run_->add_compared(truth_estimate_, bounds.norm, truth.values,
                       comparison_->errors(truth.values, state, bounds), is_compared);
  }
  if (!is_compared || !neighbourhood_) return;
  const PlantObserver& observer = truth_estimate_.law->observer();
  neighbourhood_->add_truth(truth.stamp, truth.values, state, observer.held_part(state));
}

void ReplayRun::summarize(ReplaySummary& summary) const {
  if (summary.estimates > 0) {
    summary.final_stamp = estimate_message_.header.stamp.toSec();
    summary.missing_jumps = estimate_message_.missing_jumps;
    summary.skipped_jumps = estimate_message_.skipped_jumps;
    summary.dwell_violations = estimate_message_.dwell_violations;
    for (std::size_t i = 0; i < estimate_message_.names.size(); ++i) {
      summary.final_state.emplace_back(estimate_message_.names[i], estimate_message_.state[i]);
    }
  }
  summary.diverged = how_it_diverged();
  for (const Quantity& quantity : comparison_->quantities()) {
    summary.compared.push_back(quantity.name);
  }
  summary.compared_stamps = comparison_->size();
  if (neighbourhood_) summary.apart_from_jumps = neighbourhood_->errors();
  summary.guarantee = config_.guarantee;
  summary.bounded = config_.law->has_bound();
  summary.truth_is_given = !options_.truth_topic.empty();
  summary.bound_stamps = comparison_->bound_check().stamps;
  summary.bound_exceeded = comparison_->bound_check().exceeded;
  summary.bound_share = comparison_->bound_check().share;
  for (const Comparison::BoundCheck& check : comparison_->bound_checks()) {
    summary.state_bounds.push_back({check.stamps, check.exceeded, check.share});
  }
  summary.rmse = comparison_->rmse();
  summary.hold_rmse = comparison_->hold_rmse();
  summary.rmse_norm = Comparison::norm(summary.rmse);
  summary.hold_rmse_norm = Comparison::norm(summary.hold_rmse);
}

std::string ReplayRun::how_it_diverged() const {
  if (final_is_held_) {
    return "the flow of the model is not finite at the end, and the last finite estimate is held";
  }
  for (std::size_t i = 0; i < config_.sensors.size(); ++i) {
    if (runtime_.innovation_trend(i) != InnovationTrend::kDiverging) continue;
    return "the innovations of " + config_.plant->sensors()[i].name +
           " grew a thousandfold and more, beyond what is measured: are the signs of the gains "
           "right, and the plant's model?";
  }
  return "";
}

}  // namespace sampled_data_observers
