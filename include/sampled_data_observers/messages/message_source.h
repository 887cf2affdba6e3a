#pragma once

#include <ros/datatypes.h>
#include <ros/node_handle.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/hybrid/event.h"
#include "sampled_data_observers/messages/transform_buffer.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

class MessageDefinition;

/// What a source made of a message.
enum class Reading : std::uint8_t {
  kEvent,            ///< an event
  kPassedOver,       ///< nothing: the source is thinned, or no jump is detected
  kNoField,          ///< nothing: the message does not hold a field that is configured
  kOutOfLimits,      ///< nothing: a value lies outside of the limits that are configured
  kInFuture,         ///< nothing: a detector's signal from beyond the tolerated future
  kOutOfOrder,       ///< nothing: a detector's signal whose stamp is not after the one before
  kNotFinite,        ///< nothing: a detector's signal that is NaN or infinite
  kDropped,          ///< nothing: it was not read, since too many came
  kOtherDefinition,  ///< nothing: its publisher has another type, or another definition of it
  kMalformed,        ///< nothing: its bytes are no message of its type
  kNoCovariance,     ///< nothing: the covariance in it is none
  kBeforeDatum,      ///< nothing: a fix from before the one that is the datum of the local plane
  kNoTransform  ///< nothing yet: the transform into a configured frame is not known; stamp is set
};

/// Why there is no event in a message.
/// @pre reading is neither kEvent nor kPassedOver
EventOutcome outcome_of(Reading reading);

/// A message of the type that its source has.
using MessagePointer = boost::shared_ptr<const void>;

/// Messages of one configured type from one topic, and the events that they are. The only place
/// that knows their type: live observers and replay read them alike. Of any type but the package's
/// own it takes what the definition says, and nothing is compiled for it.
class MessageSource {
 public:
  virtual ~MessageSource() = default;

  /// Takes each message and the time of its receipt.
  using Receiver = std::function<void(const MessagePointer&, Stamp)>;

  /// Subscribes to the configured topic.
  virtual ros::Subscriber subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                                    const Receiver& receive) const = 0;

  /// What a publisher, or a bag, says of the connection that messages come on: among other things
  /// "type" and "md5sum", the sum of its definition.
  using Connection = boost::shared_ptr<ros::M_string>;

  /// The message that these bytes are, as roscpp sends it.
  /// @param data        the bytes, which are copied
  /// @param size        how many they are
  /// @param connection  null: they are taken for messages of the source's own definition
  /// @throws std::exception for bytes that are none, of a type of the package's own; those of
  ///   others are looked at by read()
  virtual MessagePointer deserialize(std::uint8_t* data, std::uint32_t size,
                                     const Connection& connection) const = 0;

  /// The stamp of the event that a message is, or of what a detector reads; for any thread.
  /// @param message  one that this source gave
  /// @param receipt  the event's stamp where the source is configured so
  virtual Stamp stamp_of(const MessagePointer& message, Stamp receipt) const = 0;

  /// Sets stamp, values and size of an event whose kind is set, and what else the message says. The
  /// values live until the next call, or as long as the message.
  /// @param message  one that this source gave
  /// @param receipt  the event's stamp where the source is configured so
  /// @param event    of the kind that its channel has; a jump becomes a withdrawal where it is one
  virtual Reading read(const MessagePointer& message, Stamp receipt, Event& event) = 0;

  /// The MD5 sum of the definition by which it reads.
  virtual std::string md5sum() const = 0;

  /// What is said of a message of another definition; empty where nothing is known of its sender.
  /// @pre read() gave kOtherDefinition for it
  virtual std::string describe_sender(const MessagePointer&) const { return ""; }

  /// Told that the event read last is good (is_good()).
  virtual void confirm() {}

  /// Writes which transform a message lacks (see write_pair()).
  /// @pre read() gave kNoTransform for it, and this stamp
  virtual void name_missing_transform(const MessagePointer& message, Stamp stamp,
                                      std::string& text) const = 0;
};

/// The source that a configuration asks for.
/// @param source      topic, type and fields
/// @param transforms  where a source with frames finds what it needs; else it may be null
/// @param definition  of its type, as a bag has it; null: the one that is installed
/// @throws ConfigError for a topic that is no name of ROS (bags may have others), and a message
/// type, field or stamp that does not exist; it lists those that do, or says what to install. The
/// same for frames of a type that has none.
std::unique_ptr<MessageSource> make_message_source(
    const TopicSource& source, std::shared_ptr<const TransformBuffer> transforms = nullptr,
    std::shared_ptr<const MessageDefinition> definition = nullptr);

}  // namespace sampled_data_observers
