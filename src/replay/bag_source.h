#pragma once

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

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

/// Opens a bag for reading. @throws ReplayError when it can't be read.
void open_for_reading(rosbag::Bag& bag, const std::string& path);

/// Datatypes by topic, for all topics of a bag.
std::vector<std::pair<std::string, std::string>> bag_topics(const rosbag::Bag& bag);

/// A channel of the observer bound to a topic of a bag.
struct BagChannel {
  EventChannel channel;
  /// Absolute name of the topic in the bag.
  std::string topic;
  std::shared_ptr<MessageSource> source;
  /// Whether the bag has that topic.
  bool is_recorded = false;

  /// Makes an event of the message that the bag holds, received when it was recorded. Its values
  /// live until the next message is read.
  /// @throws ReplayError when the message can't be read as the configured type.
  Reading read(const rosbag::MessageInstance& instance, Event& event);

 private:
  MessagePointer message_;
};

/// The message of a bag as its source's type.
/// @throws ReplayError when the message can't be read as that.
MessagePointer instantiate(const MessageSource& source, const rosbag::MessageInstance& instance);

/// Binds all channels of a configuration. Relative topic names are resolved, and remapped, as ROS
/// does it.
/// @param may_lack_input  whether the topic of the input need not be in the bag
/// @throws ReplayError when the topic of a sensor, of the input or of a detector's signal is not in
/// the bag, or any topic is of another type.
/// @throws ConfigError for a source that no message type fits.
std::vector<BagChannel> bind_channels(const ObserverConfig& config, const rosbag::Bag& bag,
                                      const std::shared_ptr<const TransformBuffer>& transforms,
                                      bool may_lack_input);

/// The topics of a bag that transforms come on.
std::vector<std::string> transform_topics();

/// Takes the transforms of a message on one of these.
/// @throws ReplayError when the message can't be read as transforms.
void take_transforms(const rosbag::MessageInstance& instance, TransformBuffer& transforms);

}  // namespace sampled_data_observers
