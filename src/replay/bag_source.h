#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <rosbag/view.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {

/// A fault of a bag or of what was asked of it; the message says which and what to do.
class ReplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A message of a bag that can't be read; the message says which, but not of which bag.
class BagMessageError : public ReplayError {
 public:
  BagMessageError(const rosbag::MessageInstance& instance, const std::string& fault);
};

/// Opens a bag for reading. @throws ReplayError when it can't be read as a whole.
void open_for_reading(rosbag::Bag& bag, const std::string& path);

/// Bags that are read as one: their messages in the order of their times.
class BagSet {
 public:
  /// @throws ReplayError when one can't be read as a whole.
  explicit BagSet(const std::vector<std::string>& paths);

  /// Makes a view one of all messages, or of those on some topics.
  void look_through(rosbag::View& view) const;
  void look_through(rosbag::View& view, const std::vector<std::string>& topics) const;

  /// Datatypes by topic, for all topics.
  const std::map<std::string, std::string>& topics() const { return topics_; }

  /// The name by which the bags have a topic: `name` as it stands, which need not be one that ROS
  /// allows, or as ROS resolves and remaps it, with or without the slash in front. Where they have
  /// none of these: as ROS resolves it.
  std::string name_of(const std::string& name) const;

  /// The definition of a topic's type as its first connection has it; null where there is none.
  /// @throws ReplayError for one that is none.
  std::shared_ptr<const MessageDefinition> definition_of(const std::string& topic) const;

 private:
  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::map<std::string, std::string> topics_;
};

/// Does what reads a bag's messages; the bag's path precedes what faults say of these.
/// @throws ReplayError
template <class Action>
void name_in_faults(const std::string& path, const Action& action) {
  try {
    action();
  } catch (const BagMessageError& fault) {
    throw ReplayError(path + ": " + fault.what());
  } catch (const rosbag::BagException& fault) {
    throw ReplayError(path + ": can't be read as a bag: " + fault.what());
  }
}

/// A channel of the observer bound to a topic of a bag.
struct BagChannel {
  EventChannel channel;
  /// Name of the topic in the bags.
  std::string topic;
  std::shared_ptr<MessageSource> source;
  /// Of its type, as the bag has it; null where it has none.
  std::shared_ptr<const MessageDefinition> definition;
  /// Whether the bag has that topic.
  bool is_recorded = false;

  /// Makes an event of the message that the bag holds, received when it was recorded. Its values
  /// live until the next message is read.
  /// @throws ReplayError when the message can't be read as the configured type.
  Reading read(const rosbag::MessageInstance& instance, Event& event);

 private:
  MessagePointer message_;
};

/// The bytes of a message, which are those of its type.
/// @throws BagMessageError where they are not.
std::vector<std::uint8_t> checked_bytes(const rosbag::MessageInstance& instance);

/// The message of a bag as a type.
/// @throws BagMessageError when it can't be read as that.
template <class M>
boost::shared_ptr<const M> instantiate(const rosbag::MessageInstance& instance) {
  if (instance.getMD5Sum() != ros::message_traits::MD5Sum<M>::value()) {
    throw BagMessageError(instance, std::string("it was recorded as ") + instance.getDataType() +
                                        " with another definition, or is of another type");
  }
  std::vector<std::uint8_t> bytes = checked_bytes(instance);
  const auto message = boost::make_shared<M>();
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, *message);
  return message;
}

/// The message of a bag as its source's type.
/// @throws ReplayError when the message can't be read as that.
MessagePointer instantiate(const MessageSource& source, const rosbag::MessageInstance& instance);

/// Binds all channels of a configuration. Relative topic names are resolved, and remapped, as ROS
/// does it.
/// @param may_lack_input  whether the topic of the input need not be in the bag
/// @throws ReplayError when the topic of a sensor, of the input or of a detector's signal is not in
/// the bag, or any topic is of another type.
/// @throws ConfigError for a source that no message type fits.
std::vector<BagChannel> bind_channels(const ObserverConfig& config, const BagSet& bags,
                                      const std::shared_ptr<const TransformBuffer>& transforms,
                                      bool may_lack_input);

}  // namespace sampled_data_observers
