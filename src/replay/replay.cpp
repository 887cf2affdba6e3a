#include "sampled_data_observers/replay/replay.h"

#include <ros/names.h>
#include <rosbag/view.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "sampled_data_observers/replay/bag_source.h"
#include "sampled_data_observers/replay/comparison.h"
#include "sampled_data_observers/replay/progress_bar.h"
#include "sampled_data_observers/replay/thinning.h"
#include "sampled_data_observers/replay/truth.h"
#include "sampled_data_observers/ros/time_conversion.h"

namespace sampled_data_observers {
namespace {

class Replay {
 public:
  Replay(const ObserverConfig& config, const ReplayOptions& options)
      : config_(config), options_(options), runtime_(config) {
    open_for_reading(bag_, options.bag);
    channels_ = bind_channels(config, bag_);
    if (!options.truth_topic.empty()) {
      truth_ = truth_from_topic(config, bag_, options.truth_topic, options.truth_fields);
    } else if (options.thinning) {
      truth_ = truth_from_samples(config, channels_);
    }
    comparison_.emplace(truth_.quantities, *config.plant);
    std::vector<Quantity> plotted = truth_.quantities;
    if (plotted.empty()) {
      for (const std::string& state : config.law->estimate_names()) {
        plotted.push_back(*state_quantity(*config.plant, state));
      }
    }
    plotted_.emplace(plotted, *config.plant);
    for (const Quantity& quantity : plotted) summary_.plots.push_back({quantity.name, {}, {}, {}});
    truth_estimate_ = runtime_.estimator().make_estimate();
    if (!options.output.empty()) open_for_writing(output_, options.output);
  }

  ReplaySummary run() {
    const auto start = std::chrono::steady_clock::now();
    std::set<std::string> topics(truth_.topics.begin(), truth_.topics.end());
    for (const BagChannel& bound : channels_) topics.insert(bound.topic);
    rosbag::View view(bag_,
                      rosbag::TopicQuery(std::vector<std::string>(topics.begin(), topics.end())));
    thin_samples(view);
    {
      ProgressBar progress(view.size());
      for (const rosbag::MessageInstance& instance : view) {
        take(instance);
        progress.advance();
      }
    }
    publish_due(to_stamp(view.getEndTime()));
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
  void thin_samples(rosbag::View& view) {
    kept_.resize(channels_.size());
    next_.resize(channels_.size(), 0);
    if (!options_.thinning) return;
    std::vector<std::vector<Stamp>> stamps(channels_.size());
    Event event;
    for (const rosbag::MessageInstance& instance : view) {
      for (std::size_t i = 0; i < channels_.size(); ++i) {
        if (!is_thinned(i) || channels_[i].topic != instance.getTopic()) continue;
        channels_[i].read(instance, event);
        stamps[i].push_back(event.stamp);
      }
    }
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      kept_[i] = thin(stamps[i], from_seconds(options_.thinning->T1),
                      from_seconds(options_.thinning->T2), options_.thinning->seed + i);
    }
  }

  bool is_thinned(std::size_t channel) const {
    return options_.thinning && channels_[channel].channel.kind == EventKind::kSample;
  }

  void take(const rosbag::MessageInstance& instance) {
    const Stamp now = to_stamp(instance.getTime());
    publish_due(now);
    bool received = false;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (channels_[i].topic != instance.getTopic()) continue;
      if (is_thinned(i) && !kept_[i][next_[i]++]) {
        ++summary_.samples_withheld;
        continue;
      }
      received = true;
      receive(channels_[i], instance, now);
    }
    if (received && output_.isOpen()) {
      output_.write(instance.getTopic(), instance.getTime(), instance,
                    instance.getConnectionHeader());
    }
    if (std::find(truth_.topics.begin(), truth_.topics.end(), instance.getTopic()) !=
        truth_.topics.end()) {
      compare(instance);
    }
  }

  void receive(const BagChannel& bound, const rosbag::MessageInstance& instance, Stamp now) {
    Event event;
    event.kind = bound.channel.kind;
    event.channel = bound.channel.channel;
    bound.read(instance, event);
    const EventReport report = runtime_.receive(bound.channel, event, now, status_);
    if (output_.isOpen()) output_.write(resolved("events"), instance.getTime(), status_);
    count(event, report);
    if (report.used() && event.kind == EventKind::kSample) {
      const auto sensor = static_cast<std::size_t>(event.channel);
      comparison_->add_sample(sensor, event.stamp, event.values);
      plot_sample(sensor, event);
    }
  }

  void count(const Event& event, const EventReport& report) {
    const bool is_sample = event.kind == EventKind::kSample;
    if (!report.used()) {
      ++summary_.rejected[describe(report.outcome)];
      if (is_sample) ++summary_.samples_rejected;
      return;
    }
    ++summary_.events_used;
    if (!is_sample) return;
    ++summary_.samples_used;
    if (report.outcome == EventOutcome::kUsedLate) ++summary_.samples_late;
    if (!report.interval || report.outcome == EventOutcome::kUsedLate) return;
    const double interval = to_seconds(*report.interval);
    summary_.interval_min =
        summary_.intervals == 0 ? interval : std::min(summary_.interval_min, interval);
    summary_.interval_max = std::max(summary_.interval_max, interval);
    summary_.interval_mean += interval;  // divided at the end
    ++summary_.intervals;
    if (report.interval_check == IntervalCheck::kShort) ++summary_.intervals_short;
    if (report.interval_check == IntervalCheck::kLong) ++summary_.intervals_long;
  }

  void publish_due(Stamp now) {
    while (const Estimate* estimate = runtime_.next_due(now)) {
      runtime_.write(*estimate, estimate_message_);
      ++summary_.estimates;
      if (output_.isOpen()) {
        output_.write(resolved("estimate"), to_ros_time(estimate->stamp + config_.publish_delay),
                      estimate_message_);
      }
      for (std::size_t i = 0; i < summary_.plots.size(); ++i) {
        const Eigen::VectorXd& row = plotted_->quantities()[i].row;
        plot(summary_.plots[i].estimate, estimate->stamp,
             row.dot(estimate->state.head(row.size())));
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
    for (std::size_t i = 0; i < truth_values_.size(); ++i) {
      plot(summary_.plots[i].truth, stamp, truth_values_[i]);
    }
    const double elapsed = to_seconds(stamp - *first_truth_);
    if (elapsed < options_.from || elapsed > options_.to) return;
    const Timeline::Query query = runtime_.estimator().estimate_at(stamp, truth_estimate_);
    if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) return;
    comparison_->add_truth(truth_values_, truth_estimate_.state.data());
  }

  void plot_sample(std::size_t sensor, const Event& event) {
    summary_.sample_times.push_back(plot_time(event.stamp));
    const Eigen::MatrixXd& C = config_.plant->sensors()[sensor].C;
    for (std::size_t i = 0; i < summary_.plots.size(); ++i) {
      for (Eigen::Index output = 0; output < C.rows(); ++output) {
        if (C.row(output).transpose() == plotted_->quantities()[i].row) {
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
    if (summary_.intervals > 0) summary_.interval_mean /= static_cast<double>(summary_.intervals);
    if (summary_.estimates > 0) {
      summary_.final_stamp = estimate_message_.header.stamp.toSec();
      for (std::size_t i = 0; i < estimate_message_.names.size(); ++i) {
        summary_.final_state.emplace_back(estimate_message_.names[i], estimate_message_.state[i]);
      }
    }
    for (const Quantity& quantity : comparison_->quantities()) {
      summary_.compared.push_back(quantity.name);
    }
    summary_.compared_stamps = comparison_->size();
    summary_.rmse = comparison_->rmse();
    summary_.hold_rmse = comparison_->hold_rmse();
    summary_.rmse_norm = Comparison::norm(summary_.rmse);
    summary_.hold_rmse_norm = Comparison::norm(summary_.hold_rmse);
  }

  static std::string resolved(const char* name) { return ros::names::resolve(name); }

  const ObserverConfig& config_;
  const ReplayOptions& options_;
  ObserverRuntime runtime_;
  rosbag::Bag bag_;
  rosbag::Bag output_;
  std::vector<BagChannel> channels_;
  std::vector<std::vector<bool>> kept_;
  std::vector<std::size_t> next_;
  Truth truth_;
  std::vector<double> truth_values_;
  Estimate truth_estimate_;
  std::optional<Stamp> first_truth_;
  std::optional<Comparison> comparison_;
  std::optional<Comparison> plotted_;
  std::optional<Stamp> plot_origin_;
  EventStatus status_;
  StateEstimate estimate_message_;
  ReplaySummary summary_;
};

}  // namespace

ReplaySummary replay(const ObserverConfig& config, const ReplayOptions& options) {
  return Replay(config, options).run();
}

}  // namespace sampled_data_observers
