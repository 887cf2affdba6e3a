#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>

namespace sampled_data_observers::test {

/// What calls itself a sensor_msgs/JointState, but has other bytes.
struct MalformedMessage {
  /// Bytes: four for the sequence number, eight for the stamp, and the length of frame_id, which
  /// no bytes follow.
  std::uint32_t bytes[4] = {0, 1, 0, 1000};
};

/// What calls itself a sensor_msgs/JointState, of another definition.
struct OutdatedMessage : MalformedMessage {};

}  // namespace sampled_data_observers::test

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<sampled_data_observers::test::MalformedMessage> {
  static const char* value() { return MD5Sum<sensor_msgs::JointState>::value(); }
  static const char* value(const sampled_data_observers::test::MalformedMessage&) {
    return value();
  }
};

template <>
struct DataType<sampled_data_observers::test::MalformedMessage> {
  static const char* value() { return DataType<sensor_msgs::JointState>::value(); }
  static const char* value(const sampled_data_observers::test::MalformedMessage&) {
    return value();
  }
};

template <>
struct Definition<sampled_data_observers::test::MalformedMessage> {
  static const char* value() { return Definition<sensor_msgs::JointState>::value(); }
  static const char* value(const sampled_data_observers::test::MalformedMessage&) {
    return value();
  }
};

template <>
struct MD5Sum<sampled_data_observers::test::OutdatedMessage> {
  static const char* value() { return "00000000000000000000000000000000"; }
  static const char* value(const sampled_data_observers::test::OutdatedMessage&) { return value(); }
};

template <>
struct DataType<sampled_data_observers::test::OutdatedMessage>
    : DataType<sampled_data_observers::test::MalformedMessage> {};

template <>
struct Definition<sampled_data_observers::test::OutdatedMessage>
    : Definition<sampled_data_observers::test::MalformedMessage> {};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<sampled_data_observers::test::MalformedMessage> {
  template <class Stream>
  static void write(Stream& stream, const sampled_data_observers::test::MalformedMessage& message) {
    for (const std::uint32_t word : message.bytes) stream.next(word);
  }
  static std::uint32_t serializedLength(
      const sampled_data_observers::test::MalformedMessage& message) {
    return sizeof(message.bytes);
  }
};

template <>
struct Serializer<sampled_data_observers::test::OutdatedMessage>
    : Serializer<sampled_data_observers::test::MalformedMessage> {};

}  // namespace serialization
}  // namespace ros
