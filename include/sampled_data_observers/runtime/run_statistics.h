#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/runtime/estimator.h"
#include "sampled_data_observers/runtime/median_recorder.h"
#include "sampled_data_observers/runtime/range_recorder.h"

namespace sampled_data_observers {

/// The innovations of a sensor, of samples that were used: what a gate keeps out says nothing of
/// the noise of the others.
struct InnovationStatistics {
  /// How many there were.
  std::uint64_t count = 0;
  /// Sum of each output's; empty where nothing was recorded yet.
  std::vector<double> sums;
  /// Sum of each output's square.
  std::vector<double> squares;
  /// How many of them had a normalized square (EventReport::nis).
  std::uint64_t nis_count = 0;
  /// The sum of these.
  double nis_sum = 0.0;

  /// Takes in one, with its normalized square or NaN.
  void add(const double* innovation, Eigen::Index size, double nis);
  /// Joins others.
  void add(const InnovationStatistics& other);
  /// Forgets all, and keeps its memory.
  void clear();
  /// Of an output; NaN where there are none.
  double mean(std::size_t output) const;
  /// Root mean square of an output; NaN where there are none.
  double rms(std::size_t output) const;
  /// Mean of the normalized squares; NaN where there are none.
  double nis() const;
};

/// What became of the events of one channel.
struct ChannelStatistics {
  /// By the codes of EventOutcome.
  std::array<std::uint64_t, kEventOutcomes> outcomes{};
  /// Time of arrival minus stamp [ns].
  Range latency;
  /// Its median over the last MedianRecorder::kLength events.
  std::optional<Duration> median_latency;
  /// The newest stamp of an event that was used.
  std::optional<Stamp> newest;
  /// Time between used samples of this sensor [ns].
  Range interval;
  /// How many of them were below T1.
  std::uint64_t short_intervals = 0;
  /// How many of them were above T2.
  std::uint64_t long_intervals = 0;
  /// Stamps of the first and last samples whose interval was outside.
  Range violations;
  /// Numbers of later events that were applied again, for each late event.
  Range rewound;
  /// How many came after a bound that rested on their absence (EventReport::came_after_bound).
  std::uint64_t after_bound = 0;
  /// What was said last of a rejection, ever: the transform that is missing, say, or the publisher
  /// whose definition is another one.
  struct Detail {
    /// Of that rejection.
    EventOutcome outcome = EventOutcome::kUsed;
    /// Empty where nothing was said.
    std::string text = {};
  };
  /// Of the last one.
  Detail detail = {};
  /// The norm of the innovation of the last sample; NaN without.
  double innovation = std::numeric_limits<double>::quiet_NaN();
  /// Mean and size of them.
  InnovationStatistics innovations;
  /// What the innovations do, as of the last sample.
  InnovationTrend trend = InnovationTrend::kSteady;

  /// Number of events, whatever became of them.
  std::uint64_t received() const;
  /// Number of events with this outcome.
  std::uint64_t count(EventOutcome outcome) const {
    return outcomes[static_cast<std::size_t>(outcome)];
  }
  /// Number of events on which the estimate rests.
  std::uint64_t used() const;

  /// Joins what happened later.
  void add(const ChannelStatistics& other);
};

/// What an observer did in some time.
struct RunStatistics {
  /// Of a time in which nothing happened.
  explicit RunStatistics(std::size_t channels) : channels(channels) {}

  /// In the order of the configuration: sensors, inputs, jumps.
  std::vector<ChannelStatistics> channels;
  /// Of each estimate published: how long after it was due [ns].
  Range lateness;
  /// How many of them were held.
  std::uint64_t held = 0;
  /// How many of them stood at a bound of the observer's saturations.
  std::uint64_t saturated = 0;
  /// How many of them rest on an input older than its timeout.
  std::uint64_t input_stale = 0;
  /// Of the newest estimate: jumps that no event told of, since the start.
  std::uint64_t missing_jumps = 0;
  /// Likewise: jumps that were lost, as the numbers of the others tell.
  std::uint64_t skipped_jumps = 0;
  /// Likewise: how often the times between jumps left those configured.
  std::uint64_t dwell_violations = 0;
  /// CPU time that ticks of the publishing thread took, of those that were measured [ns].
  Range tick_cpu_time;
  /// Of the newest estimate.
  std::optional<Stamp> newest_estimate;
  /// Of the newest estimate: that on |x − x̂|, infinite or NaN as in PublishedBound.
  double error_bound = 0.0;
  /// Stamp of the first estimate without finite error bound since the last one that had one.
  std::optional<Stamp> bound_lost_since;
  /// Why the last published estimate has none.
  BoundLoss bound_loss = BoundLoss::kNone;

  /// Joins what happened later. @pre as many channels
  void add(const RunStatistics& later);
};

/// Records what an observer does. Any thread may record, without lock, allocation or waiting; one
/// thread at a time may take.
class StatisticsRecorder {
 public:
  /// All that it needs for so many channels is allocated here.
  /// @param channels      how many there are
  /// @param most_outputs  of a sensor; the innovations of more are not recorded
  explicit StatisticsRecorder(std::size_t channels, std::size_t most_outputs = 0);

  /// @param channel  position in RunStatistics::channels
  /// @param event    as it was received
  /// @param report   what became of it
  /// @param latency  time of arrival minus stamp [ns]
  void record_event(std::size_t channel, const Event& event, const EventReport& report,
                    Duration latency) noexcept;

  /// What is said of an event that is rejected. Left out where take() just reads the last one.
  void record_detail(std::size_t channel, EventOutcome outcome, const std::string& text) noexcept;

  /// An estimate that was published.
  /// @param law       whose state the estimate is
  /// @param estimate  as published
  /// @param bound     as published with it
  /// @param lateness  how long after it was due [ns]
  void record_estimate(const ObserverLaw& law, const Estimate& estimate,
                       const PublishedBound& bound, Duration lateness) noexcept;

  /// @param cpu_time  of the thread, in one tick [ns]
  void record_tick(Duration cpu_time) noexcept { tick_cpu_time_.record(cpu_time); }

  /// What was recorded since the last call. @pre as many channels
  void take(RunStatistics& statistics) noexcept;

 private:
  struct Channel {
    std::array<std::atomic<std::uint64_t>, kEventOutcomes> outcomes{};
    RangeRecorder latency;
    MedianRecorder median_latency;
    /// 0 where there is none.
    std::atomic<Stamp> newest{0};
    RangeRecorder interval;
    std::atomic<std::uint64_t> short_intervals{0};
    std::atomic<std::uint64_t> long_intervals{0};
    RangeRecorder violations;
    RangeRecorder rewound;
    std::atomic<std::uint64_t> after_bound{0};
    std::atomic<double> innovation{std::numeric_limits<double>::quiet_NaN()};
    std::atomic<InnovationTrend> trend{InnovationTrend::kSteady};
    std::mutex innovations_mutex;
    InnovationStatistics innovations;
    std::mutex detail_mutex;
    ChannelStatistics::Detail detail;
  };

  static void record_innovation(Channel& channel, Eigen::Index size,
                                const EventReport& report) noexcept;

  std::vector<Channel> channels_;
  RangeRecorder lateness_;
  RangeRecorder tick_cpu_time_;
  std::atomic<std::uint64_t> held_{0};
  std::atomic<std::uint64_t> saturated_{0};
  std::atomic<std::uint64_t> input_stale_{0};
  std::atomic<std::uint64_t> missing_jumps_{0};
  std::atomic<std::uint64_t> skipped_jumps_{0};
  std::atomic<std::uint64_t> dwell_violations_{0};
  /// 0 where there is none.
  std::atomic<Stamp> newest_estimate_{0};
  std::atomic<Stamp> bound_lost_since_{0};
  std::atomic<double> error_bound_{0.0};
  std::atomic<BoundLoss> bound_loss_{BoundLoss::kNone};
};

}  // namespace sampled_data_observers
