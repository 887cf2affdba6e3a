#include "replay/replay.h"

#include <ros/names.h>
#include <rosbag/view.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <set>
#include <sstream>

#include "console/progress_bar.h"
#include "messages/runtime_messages.h"
#include "messages/time_conversion.h"
#include "replay/bag_source.h"
#include "replay/bag_writer.h"
#include "replay/comparison.h"
#include "replay/jump_neighbourhood.h"
#include "replay/report/run_record.h"
#include "replay/summary_recorder.h"
#include "replay/thinning.h"
#include "replay/truth.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/messages/event_intake.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

/// A gap longer than this is a clock that was set, not a robot that waited.
constexpr Duration kClockJump = Duration{24} * 3600 * kNanosecondsPerSecond;

/// Of all, for people.
std::string name_of(const std::vector<std::string>& bags) {
  std::string all;
  for (const std::string& bag : bags) all += (all.empty() ? "" : " ") + bag;
  return all;
}

class Replay {
 public:
  Replay(const ObserverConfig& config, const ReplayOptions& options, RunRecord* record)
      : config_(config),
        options_(options),
        runtime_(config),
        bags_(options.bags),
        transforms_(std::make_shared<TransformBuffer>(config.static_transforms, config.navsat)) {
    channels_ = bind_channels(config, bags_, transforms_, options.may_lack_input);
    if (has_frames(config)) transform_topics_ = {bags_.name_of("/tf"), bags_.name_of("/tf_static")};
    for (const BagChannel& bound : channels_) {
      intakes_.emplace_back(
          bound.channel, bound.source,
          [this](const EventChannel& channel, const Event& event, Reading reading,
                 const std::string& missing) { return handle(channel, event, reading, missing); });
    }
    if (!options.truth_topic.empty()) {
      truth_ =
          truth_from_topic(config, bags_, options.truth_topic, options.truth_fields, transforms_);
    } else if (options.thinning) {
      truth_ = truth_from_samples(config, channels_, transforms_);
    }
    comparison_.emplace(truth_.quantities, config.plant);
    tell_jumps_apart();
    std::vector<Quantity> plotted = truth_.quantities;
    if (plotted.empty()) {
      for (const std::string& state : config.law->estimate_names()) {
        plotted.push_back(*state_quantity(*config.plant, state));
      }
    }
    recorder_.emplace(config, std::move(plotted));
    if (record != nullptr) run_.emplace(config, truth_.quantities, *record);
    for (const BagChannel& bound : channels_) {
      if (!bound.is_recorded) recorder_->add_missing_topic(bound.channel.name, bound.topic);
    }
    truth_estimate_ = runtime_.estimator().make_estimate();
    if (!options.output.empty()) output_.emplace(options.output);
  }

  ReplaySummary run() {
    const auto start = std::chrono::steady_clock::now();
    std::set<std::string> topics(transform_topics_.begin(), transform_topics_.end());
    if (!truth_.topic.empty()) topics.insert(truth_.topic);
    for (const BagChannel& bound : channels_) topics.insert(bound.topic);
    rosbag::View view;
    bags_.look_through(view, {topics.begin(), topics.end()});
    require_truth_in_range();
    thin_samples(view);
    {
      ProgressBar progress("replay", view.size());
      for (const rosbag::MessageInstance& instance : view) {
        take(instance);
        progress.advance();
      }
    }
    // The clock of a live run would go on to the end of the bag, and estimates wait for their
    // delay.
    rosbag::View all;
    bags_.look_through(all);
    const Stamp end = to_stamp(all.getEndTime());
    if (clock_) publish_due(end + std::max(config_.publish_delay, settling_time()));
    if (clock_) compare_waiting(*clock_);
    for (EventIntake& intake : intakes_) intake.give_up();
    if (output_) output_->finish();

    ReplaySummary summary = recorder_->summary();
    summary.bag = name_of(options_.bags);
    summary.observer = config_.type;
    summary.datum = transforms_->datum_text();
    summary.bag_seconds = view.size() > 0 ? (view.getEndTime() - view.getBeginTime()).toSec() : 0.0;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    summary.wall_seconds = wall.count();
    finish(summary);
    return summary;
  }

 private:
  void tell_jumps_apart() {
    const Duration stamp_error = config_.options.jump_stamp_error;
    const bool is_wanted = options_.around_jumps || stamp_error > 0;
    if (!is_wanted || truth_.quantities.empty() || !config_.plant->jumps()) return;
    const Duration around =
        options_.around_jumps ? from_seconds(*options_.around_jumps) : stamp_error;
    neighbourhood_.emplace(truth_.quantities, config_.plant, around);
  }

  /// Else a long run would end with nothing compared.
  void require_truth_in_range() {
    if (truth_.topic.empty()) return;
    rosbag::View view;
    bags_.look_through(view, {truth_.topic});
    const double length = (view.getEndTime() - view.getBeginTime()).toSec();
    if (options_.from <= length) return;
    std::ostringstream text;
    text << "--from " << options_.from << ": expected at most " << length
         << " s, since that is when the truth on " << truth_.topic << " in "
         << name_of(options_.bags) << " ends";
    throw ReplayError(text.str());
  }

  void thin_samples(rosbag::View& view) {
    kept_.resize(channels_.size());
    next_.resize(channels_.size(), 0);
    if (!options_.thinning) return;
    std::vector<std::vector<std::optional<Stamp>>> stamps(channels_.size());
    // Sources remember what they read; those of the replay proper have read nothing yet.
    const auto transforms =
        std::make_shared<TransformBuffer>(config_.static_transforms, config_.navsat);
    std::vector<BagChannel> channels =
        bind_channels(config_, bags_, transforms, options_.may_lack_input);
    Event event;
    for (const rosbag::MessageInstance& instance : view) {
      take_transforms_of(instance, *transforms);
      for (std::size_t i = 0; i < channels_.size(); ++i) {
        if (!is_thinned(i) || channels[i].topic != instance.getTopic()) continue;
        const bool is_none = channels[i].read(instance, event) == Reading::kPassedOver &&
                             channels[i].channel.source.frames.are_wanted_themselves();
        stamps[i].push_back(is_none ? std::nullopt : std::optional<Stamp>(event.stamp));
      }
    }
    const ReplayOptions::Thinning& thinning = *options_.thinning;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (!is_thinned(i)) continue;
      const SamplingBounds times = thinning.times ? *thinning.times : times_to_thin_to(i);
      kept_[i] = thin_among(stamps[i], times.T1, times.T2,
                            thinning.seed + (thinning.times ? first_on_topic(i) : i));
    }
  }

  SamplingBounds times_to_thin_to(std::size_t channel) const {
    const EventChannel& own = channels_[channel].channel;
    const SamplingBounds& times =
        config_.options.sampling.of_sensor(static_cast<std::size_t>(own.sensor));
    if (times.T1 > 0 && times.T2 < kNoLongestTime) return times;
    throw ReplayError("--thin-to-sampling: expected T1 > 0 and a T2 in the sampling of " +
                      own.name + ", found " + (times.T1 > 0 ? "no longest time" : "T1 = 0"));
  }

  /// Sensors that share a topic share its seed, so that they keep the same messages.
  std::size_t first_on_topic(std::size_t channel) const {
    std::size_t first = 0;
    while (channels_[first].topic != channels_[channel].topic) ++first;
    return first;
  }

  bool is_thinned(std::size_t channel) const {
    return options_.thinning && channels_[channel].channel.kind == EventKind::kSample;
  }

  void take(const rosbag::MessageInstance& instance) {
    const Stamp now = to_stamp(instance.getTime());
    publish_due(now);
    bool received = take_transforms_of(instance, *transforms_);
    for (EventIntake& intake : intakes_) intake.retry(now);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (channels_[i].topic != instance.getTopic()) continue;
      if (is_thinned(i) && !kept_[i][next_[i]++]) {
        recorder_->add_withheld_sample();
        continue;
      }
      received = true;
      intakes_[i].take(instantiate(*channels_[i].source, instance), now, now);
    }
    if (received) publish_due_at(now);
    if (received && output_) {
      output_->write(instance.getTopic(), instance.getTime(), instance,
                     instance.getConnectionHeader());
    }
    compare_waiting(now);
    if (instance.getTopic() == truth_.topic) compare(instance);
  }

  /// Where the message holds some. Returns whether it does.
  bool take_transforms_of(const rosbag::MessageInstance& instance, TransformBuffer& into) const {
    const std::string& topic = instance.getTopic();
    if (std::count(transform_topics_.begin(), transform_topics_.end(), topic) == 0) return false;
    take_transforms(instance, topic == transform_topics_.back(), into);
    return true;
  }

  bool handle(const EventChannel& channel, const Event& event, Reading reading,
              const std::string& missing) {
    const EventReport report = reading == Reading::kEvent
                                   ? runtime_.receive(event, *clock_)
                                   : runtime_.reject(event, outcome_of(reading), *clock_);
    write(channel, event, report, missing, *clock_, status_);
    if (output_) output_->write(resolved("events"), to_ros_time(*clock_), status_);
    recorder_->add_event(channel, event, report, status_.reason, *clock_ - event.stamp);
    if (run_) run_->add_event(event, report, status_, *clock_);
    const bool is_measurement =
        event.kind == EventKind::kSample || event.kind == EventKind::kOutput;
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
    return report.used();
  }

  /// Lets time pass as a live observer would see it: from one due estimate to the next, however
  /// long no message came.
  void publish_due(Stamp now) {
    if (clock_ && now - *clock_ < kClockJump) {
      for (Stamp due = runtime_.next_due_time(*clock_); due < now;
           due = runtime_.next_due_time(due)) {
        publish_due_at(due);
      }
    }
    publish_due_at(now);
    clock_ = now;
  }

  void publish_due_at(Stamp now) {
    while (const Estimate* estimate = runtime_.next_due(now)) {
      write(runtime_, *estimate, estimate_message_);
      final_is_held_ = estimate->held;
      recorder_->add_estimate(*estimate, runtime_.bound(*estimate).loss,
                              estimate_message_.error_bounds);
      if (run_) run_->add_estimate(*estimate, estimate_message_);
      if (output_) {
        output_->write(resolved("estimate"), to_ros_time(estimate->stamp + config_.publish_delay),
                       estimate_message_);
      }
    }
  }

  void compare(const rosbag::MessageInstance& instance) {
    Stamp stamp = 0;
    if (!truth_.read(instance, stamp, truth_values_)) return;
    if (!std::all_of(truth_values_.begin(), truth_values_.end(),
                     [](double value) { return std::isfinite(value); })) {
      return;
    }
    if (!first_truth_) first_truth_ = stamp;
    recorder_->add_truth(stamp, truth_values_);
    const double elapsed = to_seconds(stamp - *first_truth_);
    const bool is_counted = elapsed >= options_.from && elapsed <= options_.to;
    if (!is_counted && !run_) return;
    if (settling_time() == 0) {
      compare({stamp, truth_values_, is_counted});
    } else {
      waiting_truth_.push_back({stamp, truth_values_, is_counted});
    }
  }

  /// How long after a stamp its bound is known [ns].
  Duration settling_time() const {
    return config_.options.latency + config_.options.jump_stamp_error;
  }

  /// Compares what had to wait until no more events can come before its stamp.
  void compare_waiting(Stamp now) {
    while (!waiting_truth_.empty() && now - waiting_truth_.front().stamp >= settling_time()) {
      compare(waiting_truth_.front());
      waiting_truth_.pop_front();
    }
  }

  struct TruthAt {
    Stamp stamp;
    std::vector<double> values;
    bool is_counted;  ///< whether the summary is about this stamp; reports are about all
  };

  void compare(const TruthAt& truth) {
    const Timeline::Query query = runtime_.estimator().estimate_at(truth.stamp, truth_estimate_);
    if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) return;
    const double* state = truth_estimate_.state.data();
    Comparison::Bounds bounds{runtime_.bound(truth_estimate_).value};
    if (truth_estimate_.law->has_bound()) {
      bounds.states.resize(truth_estimate_.law->estimate_size());
      runtime_.state_bounds(truth_estimate_, bounds.states);
    }
    const bool is_compared =
        truth.is_counted && comparison_->add_truth(truth.values, state, bounds);
    if (run_) {
      run_->add_compared(truth_estimate_, bounds.norm, truth.values,
                         comparison_->errors(truth.values, state, bounds), is_compared);
    }
    if (!is_compared || !neighbourhood_) return;
    const PlantObserver& observer = truth_estimate_.law->observer();
    neighbourhood_->add_truth(truth.stamp, truth.values, state, observer.held_part(state));
  }

  void finish(ReplaySummary& summary) const {
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

  std::string how_it_diverged() const {
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

  static std::string resolved(const char* name) { return ros::names::resolve(name); }

  const ObserverConfig& config_;
  const ReplayOptions& options_;
  ObserverRuntime runtime_;
  const BagSet bags_;
  std::optional<BagWriter> output_;
  std::shared_ptr<TransformBuffer> transforms_;
  std::vector<std::string> transform_topics_;
  std::vector<BagChannel> channels_;
  std::vector<EventIntake> intakes_;
  std::vector<std::vector<bool>> kept_;
  std::vector<std::size_t> next_;
  Truth truth_;
  std::vector<double> truth_values_;
  Estimate truth_estimate_;
  std::optional<Stamp> first_truth_;
  std::deque<TruthAt> waiting_truth_;
  std::optional<Comparison> comparison_;
  std::optional<JumpNeighbourhood> neighbourhood_;
  std::optional<SummaryRecorder> recorder_;
  std::optional<RunRecorder> run_;  ///< only for a report
  std::optional<Stamp> clock_;
  EventStatus status_;
  StateEstimate estimate_message_;
  bool final_is_held_ = false;
};

}  // namespace

ReplaySummary replay(const ObserverConfig& config, const ReplayOptions& options,
                     RunRecord* record) {
  ReplaySummary summary;
  name_in_faults(name_of(options.bags), [&] { summary = Replay(config, options, record).run(); });
  return summary;
}

}  // namespace sampled_data_observers
