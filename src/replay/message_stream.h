#pragma once

#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "replay/bag_source.h"
#include "replay/replay.h"
#include "replay/truth.h"
#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

/// A message of the bags as a replay takes it: read and checked once, for however many runs.
struct RecordedMessage {
  /// What it is to one channel of its topic.
  struct OfChannel {
    std::size_t channel = 0;
    MessagePointer content;  ///< of that channel's source
    /// What a source makes of it that was given all messages of the channel; only where that is the
    /// same in every run (MessageStream::reads_for_all()).
    std::optional<Reading> reading;
    Event event;
    std::vector<double> values;  ///< of the event
  };
  /// What it says of the truth.
  struct OfTruth {
    Stamp stamp = 0;
    std::vector<double> values;
  };

  rosbag::MessageInstance instance;
  Stamp time = 0;  ///< of reception
  /// Null where it has no transforms.
  boost::shared_ptr<const tf2_msgs::TFMessage> transforms;
  bool are_static = false;
  std::vector<OfChannel> of_channels;
  /// As Truth::take() has it, for runs to read; null where it is none, or was read for all.
  MessagePointer unread_truth;
  std::optional<OfTruth> truth;
};

/// The messages of bags that a replay is about, in the order in which they were received.
class MessageStream {
 public:
  /// @param config   whose topics are read; outlives it
  /// @param options  outlives it
  /// @throws ReplayError, ConfigError
  MessageStream(const ObserverConfig& config, const ReplayOptions& options);

  /// What is read.
  const BagSet& bags() const { return bags_; }

  /// The channels of the configuration, with sources of their own, which have read nothing yet.
  std::vector<BagChannel> channels_with(const std::shared_ptr<TransformBuffer>& transforms) const;

  /// Of each channel that is thinned, what its messages are in the order of their reception: stamps
  /// of samples, or nothing where they hold none; empty for the others.
  using SampleStamps = std::vector<std::vector<std::optional<Stamp>>>;
  SampleStamps thinned_stamps() const;

  /// Gives all messages to `take`, one after another.
  void read(const std::function<void(RecordedMessage)>& take) const;

  /// When the last message of the bags was received, of any topic.
  Stamp end() const;
  /// From the first message read to the last [s].
  double seconds() const;

 private:
  void look_through(rosbag::View& view) const;
  void require_truth_in_range() const;
  /// Where the message holds some; else null.
  boost::shared_ptr<const tf2_msgs::TFMessage> transforms_of(
      const rosbag::MessageInstance& instance) const;
  bool are_static(const rosbag::MessageInstance& instance) const;
  bool reads_for_all(const EventChannel& channel) const;
  RecordedMessage prepare(const rosbag::MessageInstance& instance) const;
  RecordedMessage::OfChannel prepare(std::size_t channel, const rosbag::MessageInstance& instance,
                                     Stamp receipt) const;

  const ObserverConfig& config_;
  const ReplayOptions& options_;
  const BagSet bags_;
  std::shared_ptr<TransformBuffer> transforms_;
  std::vector<BagChannel> channels_;
  std::vector<std::string> transform_topics_;
  Truth truth_;
};

/// Where transforms come from, those that may change first; none where no channel needs any.
std::vector<std::string> transform_topics(const ObserverConfig& config, const BagSet& bags);

/// What the options say the truth is; empty where there is none.
Truth truth_of(const ObserverConfig& config, const ReplayOptions& options, const BagSet& bags,
               const std::vector<BagChannel>& channels,
               const std::shared_ptr<const TransformBuffer>& transforms);

/// Whether a replay keeps some messages of a channel only.
bool is_thinned(const ReplayOptions& options, const EventChannel& channel);

/// The names of the bags, for people.
std::string name_of(const std::vector<std::string>& bags);

}  // namespace sampled_data_observers
