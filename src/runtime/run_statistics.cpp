#include "sampled_data_observers/runtime/run_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

constexpr std::memory_order kRelaxed = std::memory_order_relaxed;

void increment(std::atomic<std::uint64_t>& counter) { counter.fetch_add(1, kRelaxed); }

void raise(std::atomic<Stamp>& newest, Stamp stamp) {
  Stamp seen = newest.load(kRelaxed);
  while (stamp > seen && !newest.compare_exchange_weak(seen, stamp, kRelaxed)) {
  }
}

std::optional<Stamp> as_stamp(Stamp stamp) {
  return stamp == 0 ? std::nullopt : std::optional<Stamp>(stamp);
}

}  // namespace

std::uint64_t ChannelStatistics::received() const {
  return std::accumulate(outcomes.begin(), outcomes.end(), std::uint64_t{0});
}

std::uint64_t ChannelStatistics::used() const {
  std::uint64_t sum = 0;
  for (std::size_t code = 0; code < kEventOutcomes; ++code) {
    if (is_use(static_cast<EventOutcome>(code))) sum += outcomes[code];
  }
  return sum;
}

void ChannelStatistics::add(const ChannelStatistics& other) {
  for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i] += other.outcomes[i];
  latency.add(other.latency);
  if (other.median_latency) median_latency = other.median_latency;
  if (other.newest) newest = std::max(newest.value_or(*other.newest), *other.newest);
  interval.add(other.interval);
  short_intervals += other.short_intervals;
  long_intervals += other.long_intervals;
  violations.add(other.violations);
  rewound.add(other.rewound);
  after_bound += other.after_bound;
  detail = other.detail;
  innovation = other.innovation;
  innovations.add(other.innovations);
  trend = other.trend;
}

void RunStatistics::add(const RunStatistics& later) {
  for (std::size_t i = 0; i < channels.size(); ++i) channels[i].add(later.channels[i]);
  lateness.add(later.lateness);
  held += later.held;
  saturated += later.saturated;
  input_stale += later.input_stale;
  missing_jumps = later.missing_jumps;
  skipped_jumps = later.skipped_jumps;
  dwell_violations = later.dwell_violations;
  tick_cpu_time.add(later.tick_cpu_time);
  newest_estimate = later.newest_estimate;
  error_bound = later.error_bound;
  bound_lost_since = later.bound_lost_since;
  bound_loss = later.bound_loss;
}

StatisticsRecorder::StatisticsRecorder(std::size_t channels, std::size_t most_outputs)
    : channels_(channels) {
  for (Channel& channel : channels_) {
    channel.detail.text.reserve(kLongestDetail);
    channel.innovations.sums.resize(most_outputs, 0.0);
    channel.innovations.squares.resize(most_outputs, 0.0);
  }
}

void StatisticsRecorder::record_detail(std::size_t index, EventOutcome outcome,
                                       const std::string& text) noexcept {
  Channel& channel = channels_[index];
  const std::unique_lock<std::mutex> lock(channel.detail_mutex, std::try_to_lock);
  if (!lock.owns_lock()) return;
  channel.detail.outcome = outcome;
  channel.detail.text.assign(text, 0, kLongestDetail);
}

/// Left out where take() just reads, and where there are more outputs than there is place for.
void StatisticsRecorder::record_innovation(Channel& channel, Eigen::Index size,
                                           const EventReport& report) noexcept {
  const std::unique_lock<std::mutex> lock(channel.innovations_mutex, std::try_to_lock);
  if (!lock.owns_lock() || size > static_cast<Eigen::Index>(channel.innovations.sums.size())) {
    return;
  }
  channel.innovations.add(report.innovations, size, report.nis);
}

void StatisticsRecorder::record_event(std::size_t index, const Event& event,
                                      const EventReport& report, Duration latency) noexcept {
  Channel& channel = channels_[index];
  increment(channel.outcomes[static_cast<std::size_t>(report.outcome)]);
  if (event.stamp > 0) {
    channel.latency.record(latency);
    channel.median_latency.record(latency);
  }
  if (report.used()) raise(channel.newest, event.stamp);
  if (report.rewound > 0) channel.rewound.record(static_cast<std::int64_t>(report.rewound));
  if (report.came_after_bound) increment(channel.after_bound);
  if (!std::isnan(report.innovation)) {
    channel.innovation.store(report.innovation, kRelaxed);
    channel.trend.store(report.trend, kRelaxed);
  }
  if (report.used() && report.innovations != nullptr) {
    record_innovation(channel, event.size, report);
  }
  if (!report.interval) return;
  channel.interval.record(*report.interval);
  const bool is_short = report.interval_check == IntervalCheck::kShort;
  const bool is_long = report.interval_check == IntervalCheck::kLong;
  if (is_short) increment(channel.short_intervals);
  if (is_long) increment(channel.long_intervals);
  if (is_short || is_long) channel.violations.record(event.stamp);
}

void StatisticsRecorder::record_estimate(const ObserverLaw& law, const Estimate& estimate,
                                         const PublishedBound& bound, Duration lateness) noexcept {
  lateness_.record(lateness);
  if (estimate.held) increment(held_);
  if (law.observer().is_saturated(estimate.state.data())) increment(saturated_);
  if (law.observer().is_input_stale(estimate.state.data())) increment(input_stale_);
  const double* state = estimate.state.data();
  missing_jumps_.store(static_cast<std::uint64_t>(law.missing_jumps(state)), kRelaxed);
  skipped_jumps_.store(static_cast<std::uint64_t>(law.skipped_jumps(state)), kRelaxed);
  dwell_violations_.store(static_cast<std::uint64_t>(law.dwell_violations(state)), kRelaxed);
  newest_estimate_.store(estimate.stamp, kRelaxed);
  error_bound_.store(bound.value, kRelaxed);
  // That is so at every jump, and is over soon: no loss of the guarantee.
  if (bound.loss == BoundLoss::kNearJump) return;
  bound_loss_.store(bound.loss, kRelaxed);
  if (!std::isinf(bound.value)) {
    bound_lost_since_.store(0, kRelaxed);
  } else if (bound_lost_since_.load(kRelaxed) == 0) {
    bound_lost_since_.store(estimate.stamp, kRelaxed);
  }
}

void StatisticsRecorder::take(RunStatistics& statistics) noexcept {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Channel& from = channels_[i];
    ChannelStatistics& to = statistics.channels[i];
    for (std::size_t code = 0; code < kEventOutcomes; ++code) {
      to.outcomes[code] = from.outcomes[code].exchange(0, kRelaxed);
    }
    to.latency = from.latency.take();
    to.median_latency = from.median_latency.take();
    to.newest = as_stamp(from.newest.exchange(0, kRelaxed));
    to.interval = from.interval.take();
    to.short_intervals = from.short_intervals.exchange(0, kRelaxed);
    to.long_intervals = from.long_intervals.exchange(0, kRelaxed);
    to.violations = from.violations.take();
    to.rewound = from.rewound.take();
    to.after_bound = from.after_bound.exchange(0, kRelaxed);
    to.innovation = from.innovation.load(kRelaxed);
    to.trend = from.trend.load(kRelaxed);
    {
      const std::lock_guard<std::mutex> lock(from.innovations_mutex);
      to.innovations = from.innovations;
      from.innovations.clear();
    }
    const std::lock_guard<std::mutex> lock(from.detail_mutex);
    to.detail = from.detail;
  }
  statistics.lateness = lateness_.take();
  statistics.held = held_.exchange(0, kRelaxed);
  statistics.saturated = saturated_.exchange(0, kRelaxed);
  statistics.input_stale = input_stale_.exchange(0, kRelaxed);
  statistics.missing_jumps = missing_jumps_.load(kRelaxed);
  statistics.skipped_jumps = skipped_jumps_.load(kRelaxed);
  statistics.dwell_violations = dwell_violations_.load(kRelaxed);
  statistics.tick_cpu_time = tick_cpu_time_.take();
  statistics.newest_estimate = as_stamp(newest_estimate_.load(kRelaxed));
  statistics.error_bound = error_bound_.load(kRelaxed);
  statistics.bound_loss = bound_loss_.load(kRelaxed);
  statistics.bound_lost_since = as_stamp(bound_lost_since_.load(kRelaxed));
}

}  // namespace sampled_data_observers
