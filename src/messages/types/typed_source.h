#pragma once

#include <ros/message_event.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/subscribe_options.h>
#include <std_msgs/Header.h>
#include <std_msgs/Time.h>

#include <boost/make_shared.hpp>
#include <memory>
#include <utility>

#include "messages/message_transformer.h"
#include "messages/time_conversion.h"
#include "messages/types/message_types.h"
#include "messages/value_reader.h"
#include "runtime/thinned_stamps.h"
#include "sampled_data_observers/messages/message_source.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

/// The stamp that a message carries; null for a type without.
template <class M>
const ros::Time* header_stamp(const M& message) {
  return ros::message_traits::TimeStamp<M>::pointer(message);
}
inline const ros::Time* header_stamp(const std_msgs::Header& message) { return &message.stamp; }
inline const ros::Time* header_stamp(const std_msgs::Time& message) { return &message.data; }

template <class M>
class TypedSource : public MessageSource {
 public:
  TypedSource(const TopicSource& source, std::shared_ptr<const TransformBuffer> transforms)
      : topic_(source.topic),
        by_receipt_(source.stamped_on_receipt),
        transforms_(std::move(transforms)),
        transformer_(source),
        thinned_(source.min_interval),
        reader_(source) {
    if (!by_receipt_ && header_stamp(M()) == nullptr) {
      throw ConfigError(source.origin, source.path + "/stamp",
                        "receipt (" + source.type + " carries no stamp)", "none");
    }
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

  const char* md5sum() const override { return ros::message_traits::MD5Sum<M>::value(); }

  MessagePointer deserialize(std::uint8_t* data, std::uint32_t size) const override {
    auto message = boost::make_shared<M>();
    ros::serialization::IStream stream(data, size);
    ros::serialization::deserialize(stream, *message);
    return message;
  }

  Stamp stamp_of(const MessagePointer& message, Stamp receipt) const override {
    return by_receipt_ ? receipt : to_stamp(*header_stamp(typed_message(message)));
  }

  Reading read(const MessagePointer& message, Stamp receipt, Event& event) override {
    const M& typed = typed_message(message);
    event.stamp = stamp_of(message, receipt);
    const bool has_stamp = event.stamp > 0;
    const M* wanted =
        has_stamp ? transformer_.transform(typed, event.stamp, transforms_.get()) : &typed;
    if (wanted == nullptr) return Reading::kNoTransform;
    if (!reader_.read(*wanted, event)) return Reading::kNoField;
    // What will be rejected does not take the place of the next message.
    const bool counts = has_stamp && event.size >= 0 && is_admissible(event.vector());
    return !counts || thinned_.keep(event.stamp) ? Reading::kEvent : Reading::kPassedOver;
  }

  void name_missing_transform(const MessagePointer& message, Stamp stamp,
                              std::string& text) const override {
    transformer_.name_missing(typed_message(message), stamp, *transforms_, text);
  }

 private:
  static const M& typed_message(const MessagePointer& message) {
    return *static_cast<const M*>(message.get());
  }

  std::string topic_;
  bool by_receipt_;
  std::shared_ptr<const TransformBuffer> transforms_;
  MessageTransformer<M> transformer_;
  ThinnedStamps thinned_;
  ValueReader<M> reader_;
};

/// Adds message types by their names, "package/Type".
template <class... Messages>
void add_types(MessageTypes& types) {
  const auto add = [&types](const char* name, MakeMessageSource make) { types[name] = make; };
  (add(ros::message_traits::DataType<Messages>::value(),
       [](const TopicSource& source,
          std::shared_ptr<const TransformBuffer> transforms) -> std::unique_ptr<MessageSource> {
         return std::make_unique<TypedSource<Messages>>(source, std::move(transforms));
       }),
   ...);
}

}  // namespace sampled_data_observers
