#include "replay/summary_recorder.h"

#include <algorithm>
#include <utility>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

SummaryRecorder::SummaryRecorder(const ObserverConfig& config)
    : config_(config), used_stamps_(config.sensors.size()), input_stamps_(config.inputs.size()) {
  for (const Sensor& sensor : config.plant->sensors()) {
    summary_.innovations.push_back({sensor.name, static_cast<std::size_t>(sensor.outputs()), {}});
  }
}

void SummaryRecorder::add_missing_topic(const std::string& name, const std::string& topic) {
  summary_.not_recorded[name] = topic;
}

void SummaryRecorder::add_event(const EventChannel& channel, const Event& event,
                                const EventReport& report, const std::string& reason,
                                Duration latency) {
  if (report.outcome != EventOutcome::kNoStamp) {
    Latencies& latencies = latencies_[channel.name];
    latencies.all.push_back(latency);
    if (report.outcome == EventOutcome::kInFuture) latencies.has_future = true;
  }
  count(event, report, reason);
  if (report.used() && report.innovations != nullptr) {
    summary_.innovations[static_cast<std::size_t>(event.sensor)].of.add(report.innovations,
                                                                        event.size, report.nis);
  }
}

void SummaryRecorder::count(const Event& event, const EventReport& report,
                            const std::string& reason) {
  const bool is_sample = event.kind == EventKind::kSample;
  if (report.came_after_bound) ++summary_.after_bound;
  if (!report.used()) {
    ++summary_.rejected[reason];
    if (is_sample) ++summary_.samples_rejected;
    return;
  }
  ++summary_.events_used;
  if (event.kind == EventKind::kOutput) ++summary_.outputs_used;
  if (event.kind == EventKind::kInput) {
    input_stamps_[static_cast<std::size_t>(event.sensor)].push_back(event.stamp);
  }
  if (event.kind == EventKind::kJump) ++summary_.jumps_used;
  if (report.outcome == EventOutcome::kJumpAlone) ++summary_.jumps_without_outputs;
  if (event.kind == EventKind::kWithdrawal) ++summary_.jumps_taken_back;
  if (report.recovers()) ++summary_.recovered[describe(report)];
  if (!is_sample) return;
  ++summary_.samples_used;
  if (report.outcome == EventOutcome::kUsedLate) ++summary_.samples_late;
  used_stamps_[static_cast<std::size_t>(event.sensor)].push_back(event.stamp);
}

/// Between the samples of each sensor, as they were taken, not as they arrived.
void SummaryRecorder::summarize_sensors() {
  for (std::size_t i = 0; i < used_stamps_.size(); ++i) {
    const Sensor& sensor = config_.plant->sensors()[i];
    if (sensor.timing != SensorTiming::kSampled) continue;
    std::vector<Stamp>& stamps = used_stamps_[i];
    std::sort(stamps.begin(), stamps.end());
    const SamplingBounds& bounds = config_.options.sampling.of_sensor(i);
    SensorSummary found;
    found.name = sensor.name;
    found.T1 = to_seconds(bounds.T1);
    found.T2 = longest_to_seconds(bounds.T2);
    found.samples_used = stamps.size();
    for (std::size_t k = 1; k < stamps.size(); ++k) {
      const Duration duration = stamps[k] - stamps[k - 1];
      const double interval = to_seconds(duration);
      found.intervals.add({1, interval, interval, interval,
                           duration < bounds.T1 ? std::size_t{1} : 0,
                           duration > bounds.T2 ? std::size_t{1} : 0});
    }
    summary_.sensors.push_back(std::move(found));
  }
}

void SummaryRecorder::summarize_inputs() {
  for (std::size_t i = 0; i < input_stamps_.size(); ++i) {
    std::vector<Stamp>& stamps = input_stamps_[i];
    InputSummary found;
    found.name = config_.plant->input_channels()[i].name;
    found.used = stamps.size();
    std::sort(stamps.begin(), stamps.end());
    if (!stamps.empty()) stamps.push_back(std::max(stamps.back(), last_estimate_));
    for (std::size_t k = 1; k < stamps.size(); ++k) {
      const double silence = to_seconds(stamps[k] - stamps[k - 1]);
      if (silence < found.longest_silence) continue;
      found.longest_silence = silence;
      found.silent_since = to_seconds(stamps[k - 1]);
    }
    summary_.inputs.push_back(std::move(found));
  }
}

void SummaryRecorder::summarize_latencies() {
  for (auto& [name, latencies] : latencies_) {
    const auto middle =
        latencies.all.begin() + static_cast<std::ptrdiff_t>((latencies.all.size() - 1) / 2);
    std::nth_element(latencies.all.begin(), middle, latencies.all.end());
    summary_.latencies[name] = to_seconds(*middle);
    if (latencies.has_future && *middle < 0) summary_.stamped_ahead.push_back(name);
  }
}

void SummaryRecorder::add_estimate(const Estimate& estimate, BoundLoss loss) {
  ++summary_.estimates;
  last_estimate_ = estimate.stamp;
  if (estimate.law->observer().is_input_stale(estimate.state.data())) {
    if (summary_.input_stale++ == 0) summary_.input_stale_since = to_seconds(estimate.stamp);
  }
  note_bound(estimate.stamp, loss);
}

/// That events may still come says the least, and is so from the first estimate on. Near a jump the
/// bound is not lost.
void SummaryRecorder::note_bound(Stamp stamp, BoundLoss loss) {
  if (loss == BoundLoss::kNone || loss == BoundLoss::kNearJump) return;
  const bool may_go_on = !bound_loss_ || *bound_loss_ == BoundLoss::kStillOnTheirWay;
  if (bound_loss_ && (!may_go_on || loss == *bound_loss_)) return;
  bound_loss_ = loss;
  summary_.bound_lost_at = to_seconds(stamp);
  summary_.bound_loss = describe(loss);
}

ReplaySummary SummaryRecorder::summary() {
  summarize_sensors();
  summarize_inputs();
  summarize_latencies();
  return std::move(summary_);
}

}  // namespace sampled_data_observers
