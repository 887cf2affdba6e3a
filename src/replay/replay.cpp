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
#include "replay/comparison.h"
#include "replay/thinning.h"
#include "replay/truth.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/messages/event_intake.h"

namespace sampled_data_observers {
namespace {

/// A gap longer than this is a clock that was set, not a robot that waited.
constexpr Duration kClockJump = Duration{24} * 3600 * kNanosecondsPerSecond;

class Replay {
 public:
  Replay(const ObserverConfig& config, const ReplayOptions& options)
      : config_(config),
        options_(options),
        runtime_(config),
        transforms_(std::make_shared<TransformBuffer>(config.static_transforms)) {
    open_for_reading(bag_, options.bag);
    channels_ = bind_channels(config, bag_, transforms_, options.may_lack_input);
    if (has_frames(config)) transform_topics_ = transform_topics();
    for (const BagChannel& bound : channels_) {
      if (!bound.is_recorded) summary_.not_recorded[bound.channel.name] = bound.topic;
      intakes_.emplace_back(
          bound.channel, bound.source,
          [this](const EventChannel& channel, const Event& event, Reading reading,
                 const std::string& missing) { handle(channel, event, reading, missing); });
    }
    if (!options.truth_topic.empty()) {
      truth_ = truth_from_topic(config, bag_, options.truth_topic, options.truth_fields);
    } else if (options.thinning) {
      truth_ = truth_from_samples(config, channels_, transforms_);
    }
    comparison_.emplace(truth_.quantities, config.plant);
    plotted_ = truth_.quantities;
    if (plotted_.empty()) {
      for (const std::string& state : config.law->estimate_names()) {
        plotted_.push_back(*state_quantity(*config.plant, state));
      }
    }
    for (const Quantity& quantity : plotted_) summary_.plots.push_back({quantity.name, {}, {}, {}});
    used_stamps_.resize(config.sensors.size());
    truth_estimate_ = runtime_.estimator().make_estimate();
    if (!options.output.empty()) open_for_writing(output_, options.output);
  }

  ReplaySummary run() {
    const auto start = std::chrono::steady_clock::now();
    std::set<std::string> topics(transform_topics_.begin(), transform_topics_.end());
    if (!truth_.topic.empty()) topics.insert(truth_.topic);
    for (const BagChannel& bound : channels_) topics.insert(bound.topic);
    rosbag::View view(bag_,
                      rosbag::TopicQuery(std::vector<std::string>(topics.begin(), topics.end())));
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
    rosbag::View all(bag_);
    const Stamp end = to_stamp(all.getEndTime());
    if (clock_) publish_due(end + std::max(config_.publish_delay, config_.options.latency));
    if (clock_) compare_waiting(*clock_);
    for (EventIntake& intake : intakes_) intake.give_up();
    output_.close();

    summary_.bag = options_.bag;
    summary_.observer = config_.type;
    summary_.bag_seconds =
        view.size() > 0 ? (view.getEndTime() - view.getBeginTime()).toSec() : 0.0;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    summary_.wall_seconds = wall.count();
    finish_summary();
    return std::move(summary_);
  }

 private:
  /// Else a long run would end with nothing compared.
  void require_truth_in_range() {
    if (truth_.topic.empty()) return;
    rosbag::View view(bag_, rosbag::TopicQuery(truth_.topic));
    const double length = (view.getEndTime() - view.getBeginTime()).toSec();
    if (options_.from <= length) return;
    std::ostringstream text;
    text << "--from " << options_.from << ": expected at most " << length
         << " s, since that is when the truth on " << truth_.topic << " in " << options_.bag
         << " ends";
    throw ReplayError(text.str());
  }

  void thin_samples(rosbag::View& view) {
    kept_.resize(channels_.size());
    next_.resize(channels_.size(), 0);
    if (!options_.thinning) return;
    std::vector<std::vector<Stamp>> stamps(channels_.size());
    // Sources remember what they read; those of the replay proper have read nothing yet.
    std::vector<BagChannel> channels =
        bind_channels(config_, bag_, transforms_, options_.may_lack_input);
    Event event;
    for (const rosbag::MessageInstance& instance : view) {
      for (std::size_t i = 0; i < channels_.size(); ++i) {
        if (!is_thinned(i) || channels[i].topic != instance.getTopic()) continue;
        channels[i].read(instance, event);
        stamps[i].push_back(event.stamp);
      }
    }
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      kept_[i] =
          thin(stamps[i], from_seconds(options_.thinning->T1), from_seconds(options_.thinning->T2),
               options_.thinning->seed + first_on_topic(i));
    }
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
    bool received = is_transform(instance.getTopic());
    if (received) take_transforms(instance, *transforms_);
    for (EventIntake& intake : intakes_) intake.retry(now);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (channels_[i].topic != instance.getTopic()) continue;
      if (is_thinned(i) && !kept_[i][next_[i]++]) {
        ++summary_.samples_withheld;
        continue;
      }
      received = true;
      intakes_[i].take(instantiate(*channels_[i].source, instance), now, now);
    }
    if (received) publish_due_at(now);
    if (received && output_.isOpen()) {
      output_.write(instance.getTopic(), instance.getTime(), instance,
                    instance.getConnectionHeader());
    }
    compare_waiting(now);
    if (instance.getTopic() == truth_.topic) compare(instance);
  }

  bool is_transform(const std::string& topic) const {
    return std::count(transform_topics_.begin(), transform_topics_.end(), topic) > 0;
  }

  void handle(const EventChannel& channel, const Event& event, Reading reading,
              const std::string& missing) {
    const EventReport report = reading == Reading::kEvent
                                   ? runtime_.receive(event, *clock_)
                                   : runtime_.reject(event, outcome_of(reading), *clock_);
    write(channel, event, report, missing, *clock_, status_);
    if (output_.isOpen()) output_.write(resolved("events"), to_ros_time(*clock_), status_);
    count(event, report);
    const bool is_measurement =
        event.kind == EventKind::kSample || event.kind == EventKind::kOutput;
    if (report.used() && is_measurement) {
      const auto sensor = static_cast<std::size_t>(event.channel);
      comparison_->add_sample(sensor, event.stamp, event.values);
      if (event.kind == EventKind::kSample) plot_sample(sensor, event);
    }
  }

  void count(const Event& event, const EventReport& report) {
    const bool is_sample = event.kind == EventKind::kSample;
    if (report.came_after_bound) ++summary_.after_bound;
    if (!report.used()) {
      ++summary_.rejected[status_.reason];
      if (is_sample) ++summary_.samples_rejected;
      return;
    }
    ++summary_.events_used;
    if (event.kind == EventKind::kOutput) ++summary_.outputs_used;
    if (event.kind == EventKind::kJump) ++summary_.jumps_used;
    if (!is_sample) return;
    ++summary_.samples_used;
    if (report.outcome == EventOutcome::kUsedLate) ++summary_.samples_late;
    if (report.recovers()) ++summary_.recovered[describe(report)];
    used_stamps_[static_cast<std::size_t>(event.channel)].push_back(event.stamp);
  }

  /// Between the samples of each sensor, as they were taken, not as they arrived.
  void count_intervals() {
    double sum = 0.0;
    for (std::vector<Stamp>& stamps : used_stamps_) {
      std::sort(stamps.begin(), stamps.end());
      for (std::size_t i = 1; i < stamps.size(); ++i) {
        const Duration duration = stamps[i] - stamps[i - 1];
        const double interval = to_seconds(duration);
        summary_.interval_min =
            summary_.intervals == 0 ? interval : std::min(summary_.interval_min, interval);
        summary_.interval_max = std::max(summary_.interval_max, interval);
        sum += interval;
        ++summary_.intervals;
        if (duration < config_.options.sampling.T1) ++summary_.intervals_short;
        if (duration > config_.options.sampling.T2) ++summary_.intervals_long;
      }
    }
    if (summary_.intervals > 0) sum /= static_cast<double>(summary_.intervals);
    summary_.interval_mean = sum;
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
      ++summary_.estimates;
      note_bound(estimate->stamp, runtime_.bound(*estimate).loss);
      if (output_.isOpen()) {
        output_.write(resolved("estimate"), to_ros_time(estimate->stamp + config_.publish_delay),
                      estimate_message_);
      }
      for (std::size_t i = 0; i < summary_.plots.size(); ++i) {
        const Eigen::VectorXd& row = plotted_[i].row;
        plot(summary_.plots[i].estimate, estimate->stamp,
             row.dot(estimate->state.head(row.size())));
      }
    }
  }

  /// That events may still come says the least, and is so from the first estimate on.
  void note_bound(Stamp stamp, BoundLoss loss) {
    if (loss == BoundLoss::kNone) return;
    const bool may_go_on = !bound_loss_ || *bound_loss_ == BoundLoss::kStillOnTheirWay;
    if (bound_loss_ && (!may_go_on || loss == *bound_loss_)) return;
    bound_loss_ = loss;
    summary_.bound_lost_at = to_seconds(stamp);
    summary_.bound_loss = describe(loss);
  }

  void compare(const rosbag::MessageInstance& instance) {
    Stamp stamp = 0;
    if (!truth_.read(instance, stamp, truth_values_)) return;
    if (!std::all_of(truth_values_.begin(), truth_values_.end(),
                     [](double value) { return std::isfinite(value); })) {
      return;
    }
    if (!first_truth_) first_truth_ = stamp;
    for (std::size_t i = 0; i < truth_values_.size(); ++i) {
      plot(summary_.plots[i].truth, stamp, truth_values_[i]);
    }
    const double elapsed = to_seconds(stamp - *first_truth_);
    if (elapsed < options_.from || elapsed > options_.to) return;
    if (config_.options.latency == 0) {
      compare(stamp, truth_values_);
    } else {
      waiting_truth_.push_back({stamp, truth_values_});
    }
  }

  /// Compares what had to wait until no more events can come before its stamp.
  void compare_waiting(Stamp now) {
    while (!waiting_truth_.empty() &&
           now - waiting_truth_.front().stamp >= config_.options.latency) {
      compare(waiting_truth_.front().stamp, waiting_truth_.front().values);
      waiting_truth_.pop_front();
    }
  }

  void compare(Stamp stamp, const std::vector<double>& values) {
    const Timeline::Query query = runtime_.estimator().estimate_at(stamp, truth_estimate_);
    if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) return;
    comparison_->add_truth(values, truth_estimate_.state.data(),
                           runtime_.bound(truth_estimate_).value);
  }

  void plot_sample(std::size_t sensor, const Event& event) {
    summary_.sample_times.push_back(plot_time(event.stamp));
    for (std::size_t i = 0; i < summary_.plots.size(); ++i) {
      for (Eigen::Index output = 0; output < event.size; ++output) {
        if (measures(*config_.plant, sensor, output, plotted_[i])) {
          plot(summary_.plots[i].samples, event.stamp, event.values[output]);
        }
      }
    }
  }

  double plot_time(Stamp stamp) {
    if (!plot_origin_) plot_origin_ = stamp;
    return to_seconds(stamp - *plot_origin_);
  }

  void plot(Series& series, Stamp stamp, double value) {
    series.times.push_back(plot_time(stamp));
    series.values.push_back(value);
  }

  void finish_summary() {
    count_intervals();
    if (summary_.estimates > 0) {
      summary_.final_stamp = estimate_message_.header.stamp.toSec();
      for (std::size_t i = 0; i < estimate_message_.names.size(); ++i) {
        summary_.final_state.emplace_back(estimate_message_.names[i], estimate_message_.state[i]);
      }
    }
    summary_.diverged = how_it_diverged();
    for (const Quantity& quantity : comparison_->quantities()) {
      summary_.compared.push_back(quantity.name);
    }
    summary_.compared_stamps = comparison_->size();
    summary_.guarantee = config_.guarantee;
    summary_.bounded = !std::isnan(config_.law->error_bound(truth_estimate_.state.data()));
    summary_.truth_is_given = !options_.truth_topic.empty();
    summary_.bound_stamps = comparison_->bound_check().stamps;
    summary_.bound_exceeded = comparison_->bound_check().exceeded;
    summary_.bound_share = comparison_->bound_check().share;
    summary_.rmse = comparison_->rmse();
    summary_.hold_rmse = comparison_->hold_rmse();
    summary_.rmse_norm = Comparison::norm(summary_.rmse);
    summary_.hold_rmse_norm = Comparison::norm(summary_.hold_rmse);
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
  rosbag::Bag bag_;
  rosbag::Bag output_;
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
  struct WaitingTruth {
    Stamp stamp;
    std::vector<double> values;
  };
  std::deque<WaitingTruth> waiting_truth_;
  std::optional<BoundLoss> bound_loss_;
  std::optional<Comparison> comparison_;
  std::vector<Quantity> plotted_;
  std::vector<std::vector<Stamp>> used_stamps_;
  std::optional<Stamp> clock_;
  std::optional<Stamp> plot_origin_;
  EventStatus status_;
  StateEstimate estimate_message_;
  bool final_is_held_ = false;
  ReplaySummary summary_;
};

}  // namespace

ReplaySummary replay(const ObserverConfig& config, const ReplayOptions& options) {
  return Replay(config, options).run();
}

}  // namespace sampled_data_observers
