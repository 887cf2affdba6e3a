#pragma once

#include <ros/node_handle.h>
#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>
#include <sampled_data_observers/StateEstimate.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messages/definition/message_writer.h"
#include "messages/local_plane.h"
#include "messages/raw_message.h"
#include "messages/time_conversion.h"
#include "simulation/simulator.h"

namespace sampled_data_observers {

/// Messages of a type that sources read, with the values that these are to find in them. They hold
/// the variance of the noise, too, where it is known and their type has a place for it.
class MessageEncoder {
 public:
  /// @param readings  of one type, at least one; values of messages are those of one after the
  ///   other
  /// @param navsat  the local plane, for values in it
  /// @throws ConfigError for a type or field that does not exist, a field that is read twice,
  /// frames that its messages have no use for, or a local plane whose datum is not given.
  explicit MessageEncoder(const std::vector<SimulatedReading>& readings,
                          const std::optional<NavSatDatum>& navsat = std::nullopt);

  RawMessage encode(const SimulatedMessage& from) const;

  /// How its messages are advertised.
  ros::AdvertiseOptions advertise_options(const std::string& topic, std::uint32_t queue) const;

 private:
  /// A sensor_msgs/NavSatFix in the messages: which of the values are in the plane.
  struct Fix {
    MessagePath path;
    std::array<std::optional<std::size_t>, 3> values;  ///< east, north, up
  };

  void add_reading(const SimulatedReading& reading);
  void add_field(const std::string& text, const TopicSource& source);
  void add_variances(const SimulatedReading& reading, const std::string& prefix);
  void require_free(const MessageField& field, const std::string& text,
                    const TopicSource& source) const;
  void add_fix(const Fix& fix, const std::vector<double>& values,
               std::vector<MessageItem>& items) const;

  std::shared_ptr<const MessageDefinition> definition_;
  std::shared_ptr<const LocalPlane> plane_;
  bool has_mode_;
  /// Without those of fixes; with the stamp as the last one, where messages have one.
  std::vector<MessageItem> items_;
  /// Of each value, the mode first, which item has it; nothing for those in fixes_.
  std::vector<std::optional<std::size_t>> item_of_;
  std::vector<Fix> fixes_;
  bool has_stamp_ = false;
  boost::shared_ptr<ros::M_string> connection_;
};

/// What a simulation sends, as ROS messages.
class SimulatedMessages {
 public:
  /// @throws ConfigError as MessageEncoder
  explicit SimulatedMessages(const std::vector<SimulatedChannel>& channels,
                             const std::optional<NavSatDatum>& navsat = std::nullopt);

  ros::Publisher advertise(std::size_t channel, ros::NodeHandle& handle, std::uint32_t queue) const;

  /// Calls `visitor` with the message that a simulated one stands for.
  template <class Visitor>
  void visit(const SimulatedMessage& simulated, Visitor&& visitor) const {
    using Kind = SimulatedChannel::Kind;
    const SimulatedChannel& channel = channels_[simulated.channel];
    const SimulatedMessage from = uncorrected(channel, simulated);
    if (encoders_[from.channel]) return visitor(encoders_[from.channel]->encode(from));
    switch (channel.kind) {
      case Kind::kMeasurement:
      case Kind::kSignal:
        return visitor(made<Measurement>(channel, from));
      case Kind::kInput:
        return visitor(made<Input>(channel, from));
      case Kind::kJump:
        return visitor(made<JumpEvent>(channel, from));
      case Kind::kTruth:
        break;
    }
    visitor(made<StateEstimate>(channel, from));
  }

 private:
  /// With the stamp and values that the sources correct to those simulated.
  static SimulatedMessage uncorrected(const SimulatedChannel& channel, SimulatedMessage message);
  template <class M>
  static M made(const SimulatedChannel& channel, const SimulatedMessage& from) {
    M message;
    message.header.stamp = to_ros_time(from.stamp);
    fill(channel, from, message);
    return message;
  }
  static void fill(const SimulatedChannel& channel, const SimulatedMessage& from,
                   Measurement& message);
  static void fill(const SimulatedChannel& channel, const SimulatedMessage& from, Input& message);
  static void fill(const SimulatedChannel& channel, const SimulatedMessage& from,
                   JumpEvent& message);
  static void fill(const SimulatedChannel& channel, const SimulatedMessage& from,
                   StateEstimate& message);

  std::vector<SimulatedChannel> channels_;
  /// Of channels that are of another package's type.
  std::vector<std::optional<MessageEncoder>> encoders_;
};

}  // namespace sampled_data_observers
