#pragma once

#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <string>
#include <vector>

#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers::test {

constexpr Stamp kStamp = 12'000'000'034;
constexpr Stamp kReceipt = 13'000'000'000;

/// The source of a sensor whose messages are of type M.
template <class M>
TopicSource source(const std::vector<std::string>& fields) {
  TopicSource result;
  result.topic = "topic";
  result.type = ros::message_traits::DataType<M>::value();
  result.fields = fields;
  result.size = fields.size();
  result.stamped_on_receipt = ros::message_traits::TimeStamp<M>::pointer(M()) == nullptr;
  result.origin = "file.yaml:3";
  result.path = "sensors/s/source";
  return result;
}

inline void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(std::string::npos, text.find(part)) << text;
}

/// A message as a publisher sends it to a source.
template <class M>
MessagePointer sent(const MessageSource& to, const M& message) {
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  const auto size = static_cast<std::uint32_t>(bytes.num_bytes - 4);  // without the length
  return to.deserialize(bytes.message_start, size, nullptr);
}

/// An event with its values.
struct Read {
  Reading reading = Reading::kEvent;
  Event event;
  std::vector<double> values;
};

template <class M>
Read read(MessageSource& source, const M& message, EventKind kind = EventKind::kSample,
          Stamp receipt = kReceipt) {
  Read result;
  result.event.kind = kind;
  result.reading = source.read(sent(source, message), receipt, result.event);
  if (result.reading == Reading::kEvent && result.event.size > 0) {
    result.values.assign(result.event.values, result.event.values + result.event.size);
  }
  return result;
}

template <class M>
Read read(const M& message, const std::vector<std::string>& fields) {
  return read(*make_message_source(source<M>(fields)), message);
}

}  // namespace sampled_data_observers::test
