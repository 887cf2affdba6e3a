#pragma once

#include <ros/message_event.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/subscribe_options.h>

#include <boost/make_shared.hpp>
#include <stdexcept>
#include <string>

#include "messages/corrected_values.h"
#include "messages/value_reader.h"
#include "runtime/thinned_stamps.h"
#include "sampled_data_observers/messages/message_source.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

/// Messages of a type M of the package's own. They are compiled, so that they pass by pointer
/// within a process.
template <class M>
class OwnSource : public MessageSource {
 public:
  /// @throws ConfigError
  explicit OwnSource(const TopicSource& source)
      : topic_(source.topic),
        by_receipt_(source.stamped_on_receipt),
        stamp_offset_(source.stamp_offset),
        corrected_(source),
        thinned_(source.min_interval),
        reader_(source) {
    if (!source.frames.any()) return;
    const bool is_frame = !source.frames.frame.empty();
    throw ConfigError(source.origin, source.path + (is_frame ? "/frame" : "/body_frame"),
                      "none (nothing in " + source.type + " depends on a frame)",
                      "'" + (is_frame ? source.frames.frame : source.frames.body_frame) + "'");
  }

  ros::Subscriber subscribe(ros::NodeHandle& handle, std::uint32_t queue_length,
                            const Receiver& receive) const override {
    using Message = const ros::MessageEvent<const M>&;
    ros::SubscribeOptions options;
    options.initByFullCallbackType<Message>(topic_, queue_length, [receive](Message message) {
      receive(message.getConstMessage(), to_stamp(message.getReceiptTime()));
    });
    options.transport_hints.tcpNoDelay();
    return handle.subscribe(options);
  }

  MessagePointer deserialize(std::uint8_t* data, std::uint32_t size,
                             const Connection& connection) const override {
    const std::string expected = ros::message_traits::MD5Sum<M>::value();
    if (connection != nullptr && (*connection)["md5sum"] != expected) {
      throw std::runtime_error(std::string("its ") + ros::message_traits::DataType<M>::value() +
                               " was recorded with another definition than this one's");
    }
    auto message = boost::make_shared<M>();
    ros::serialization::IStream stream(data, size);
    ros::serialization::deserialize(stream, *message);
    return message;
  }

  Stamp stamp_of(const MessagePointer& message, Stamp receipt) const override {
    const Stamp stamp = by_receipt_ ? receipt : to_stamp(typed(message).header.stamp);
    return stamp > 0 ? stamp + stamp_offset_ : stamp;
  }

  Reading read(const MessagePointer& message, Stamp receipt, Event& event) override {
    event.stamp = stamp_of(message, receipt);
    if (!reader_.read(typed(message), event)) return Reading::kNoField;
    if (!corrected_.apply(event)) return Reading::kOutOfLimits;
    // What will be rejected does not take the place of the next message.
    const bool counts = event.stamp > 0 && event.size >= 0 && is_admissible(event.vector());
    return !counts || thinned_.keep(event.stamp) ? Reading::kEvent : Reading::kPassedOver;
  }

  std::string md5sum() const override { return ros::message_traits::MD5Sum<M>::value(); }

  void name_missing_transform(const MessagePointer&, Stamp, std::string&) const override {}

 private:
  static const M& typed(const MessagePointer& message) {
    return *static_cast<const M*>(message.get());
  }

  std::string topic_;
  bool by_receipt_;
  Duration stamp_offset_;
  CorrectedValues corrected_;
  ThinnedStamps thinned_;
  ValueReader<M> reader_;
};

}  // namespace sampled_data_observers
