#pragma once

#include <ros/datatypes.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// A message as it was sent, of any type.
struct RawMessage {
  std::vector<std::uint8_t> bytes;
  /// What its publisher said of the connection that it came on; null: nothing.
  boost::shared_ptr<ros::M_string> connection;

  /// Whether its publisher has that definition.
  bool is_of(const std::string& type, const std::string& md5sum) const {
    return connection == nullptr || (says("md5sum", md5sum) && says("type", type));
  }

 private:
  bool says(const char* key, const std::string& value) const {
    const auto found = connection->find(key);
    return found != connection->end() && found->second == value;
  }
};

}  // namespace sampled_data_observers

// So roscpp takes it for a message of any type. Its names are those of roscpp.
namespace ros {
namespace message_traits {

template <>
struct IsMessage<sampled_data_observers::RawMessage> : TrueType {};
template <>
struct IsMessage<const sampled_data_observers::RawMessage> : TrueType {};

template <>
struct MD5Sum<sampled_data_observers::RawMessage> {
  static const char* value() { return "*"; }
};

template <>
struct DataType<sampled_data_observers::RawMessage> {
  static const char* value() { return "*"; }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<sampled_data_observers::RawMessage> {
  template <class Stream>
  static void read(Stream& stream, sampled_data_observers::RawMessage& message) {
    message.bytes.assign(stream.getData(), stream.getData() + stream.getLength());
  }
};

template <>
struct PreDeserialize<sampled_data_observers::RawMessage> {
  static void notify(const PreDeserializeParams<sampled_data_observers::RawMessage>& params) {
    params.message->connection = params.connection_header;
  }
};

}  // namespace serialization
}  // namespace ros
