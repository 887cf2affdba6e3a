#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "replay/summary.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

/// What a replay says of its events and estimates: how many there were, the times between samples,
/// and when the bound was lost.
class SummaryRecorder {
 public:
  /// @param config  outlives it
  explicit SummaryRecorder(const ObserverConfig& config);

  void add_missing_topic(const std::string& name, const std::string& topic);
  void add_withheld_sample() { ++summary_.samples_withheld; }
  /// @param reason  as the event's status has it
  /// @param latency  time of its arrival minus its stamp [ns]
  void add_event(const EventChannel& channel, const Event& event, const EventReport& report,
                 const std::string& reason, Duration latency);
  void add_estimate(const Estimate& estimate, BoundLoss loss);

  /// All that was added. The rest is for who knows it to fill in.
  ReplaySummary summary();

 private:
  void count(const Event& event, const EventReport& report, const std::string& reason);
  void summarize_sensors();
  void summarize_inputs();
  void summarize_latencies();
  void note_bound(Stamp stamp, BoundLoss loss);

  const ObserverConfig& config_;
  std::vector<std::vector<Stamp>> used_stamps_;   ///< of the samples of each sensor
  std::vector<std::vector<Stamp>> input_stamps_;  ///< likewise of each source of inputs
  /// Of each source of events.
  struct Latencies {
    std::vector<Duration> all;
    bool has_future = false;
  };
  std::map<std::string, Latencies> latencies_;
  Stamp last_estimate_ = 0;
  std::optional<BoundLoss> bound_loss_;
  ReplaySummary summary_;
};

}  // namespace sampled_data_observers
