#pragma once

#include <ros/datatypes.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <algorithm>
#include <array>
#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// The bytes of a message. Those of most sensors' are held inside, so that a message takes one
/// allocation.
class MessageBytes {
 public:
  MessageBytes() {}  // leaves what is inside as it is
  MessageBytes(const std::vector<std::uint8_t>& bytes) {
    assign(bytes.data(), bytes.data() + bytes.size());
  }

  void assign(const std::uint8_t* begin, const std::uint8_t* end) {
    size_ = static_cast<std::size_t>(end - begin);
    if (size_ > inside_.size()) outside_.resize(size_);
    std::copy(begin, end, data());
  }

  std::uint8_t* data() { return size_ > inside_.size() ? outside_.data() : inside_.data(); }
  const std::uint8_t* data() const {
    return size_ > inside_.size() ? outside_.data() : inside_.data();
  }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_ = 0;
  std::array<std::uint8_t, 768> inside_;  // an Odometry has 712 and the names of its frames
  std::vector<std::uint8_t> outside_;
};

/// A message as it was sent, of any type.
struct RawMessage {
  MessageBytes bytes;
  /// What its publisher said of the connection that it came on; null: nothing.
  boost::shared_ptr<ros::M_string> connection;

  /// Whether its publisher has that definition.
  bool is_of(const std::string& type, const std::string& md5sum) const {
    return connection == nullptr || (said("md5sum") == md5sum && said("type") == type);
  }

  /// "*" where that is not said.
  const char* said(const char* key) const {
    if (connection == nullptr) return "*";
    const auto found = connection->find(key);
    return found == connection->end() ? "*" : found->second.c_str();
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
  static const char* value(const sampled_data_observers::RawMessage& message) {
    return message.said("md5sum");
  }
};

template <>
struct DataType<sampled_data_observers::RawMessage> {
  static const char* value() { return "*"; }
  static const char* value(const sampled_data_observers::RawMessage& message) {
    return message.said("type");
  }
};

template <>
struct Definition<sampled_data_observers::RawMessage> {
  static const char* value(const sampled_data_observers::RawMessage& message) {
    return message.said("message_definition");
  }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<sampled_data_observers::RawMessage> {
  template <class Stream>
  static void read(Stream& stream, sampled_data_observers::RawMessage& message) {
    message.bytes.assign(stream.getData(), stream.getData() + stream.getLength());
  }
  template <class Stream>
  static void write(Stream& stream, const sampled_data_observers::RawMessage& message) {
    const sampled_data_observers::MessageBytes& bytes = message.bytes;
    std::copy_n(bytes.data(), bytes.size(), stream.advance(serializedLength(message)));
  }
  static std::uint32_t serializedLength(const sampled_data_observers::RawMessage& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
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
