#pragma once

#include <sampled_data_observers/EventStatus.h>
#include <sampled_data_observers/StateEstimate.h>

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "replay/bag_writer.h"
#include "replay/comparison.h"
#include "replay/jump_neighbourhood.h"
#include "replay/message_stream.h"
#include "replay/replay.h"
#include "replay/report/run_record.h"
#include "replay/summary_recorder.h"
#include "replay/truth.h"
#include "sampled_data_observers/messages/event_intake.h"
#include "sampled_data_observers/runtime/observer_runtime.h"

namespace sampled_data_observers {

/// One observer that is given the messages of bags, and what is said of it. To be used by one
/// thread at a time, like the law of its configuration.
class ReplayRun {
 public:
  /// @param config   outlives it
  /// @param options  outlives it
  /// @param messages  those of which it is given; the channels of its configuration are the same
  /// @param stamps   MessageStream::thinned_stamps() of them
  /// @param record   where not null, all that a report shows of the run is written there
  /// @throws ReplayError, ConfigError, OutputError
  ReplayRun(const ObserverConfig& config, const ReplayOptions& options,
            const MessageStream& messages, const MessageStream::SampleStamps& stamps,
            RunRecord* record);
  ReplayRun(const ReplayRun&) = delete;
  ReplayRun& operator=(const ReplayRun&) = delete;

  /// Takes the next message.
  void take(const RecordedMessage& message);

  /// Goes on to where the bags end, and says what was found; how long it took is for who knows.
  ReplaySummary finish(const MessageStream& messages);

 private:
  struct TruthAt {
    Stamp stamp;
    std::vector<double> values;
    bool is_counted;  ///< whether the summary is about this stamp; reports are about all
  };

  void tell_jumps_apart();
  void choose_samples(const MessageStream::SampleStamps& stamps);
  SamplingBounds times_to_thin_to(std::size_t channel) const;
  std::size_t first_on_topic(std::size_t channel) const;
  bool handle(const EventChannel& channel, const Event& event, Reading reading,
              const std::string& missing);
  void publish_due(Stamp now);
  void publish_due_at(Stamp now);
  Duration settling_time() const;
  void take_part(const RecordedMessage::OfChannel& part, Stamp now);
  void take_truth(Stamp stamp, const std::vector<double>& values);
  void compare_waiting(Stamp now);
  void compare(const TruthAt& truth);
  void summarize(ReplaySummary& summary) const;
  std::string how_it_diverged() const;

  const ObserverConfig& config_;
  const ReplayOptions& options_;
  ObserverRuntime runtime_;
  std::optional<BagWriter> output_;
  std::shared_ptr<TransformBuffer> transforms_;
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

}  // namespace sampled_data_observers
