#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "files/output_file.h"
#include "replay/bag_file_writer.h"

namespace sampled_data_observers {

/// A bag as output of a tool, whole or not there.
class BagWriter {
 public:
  /// @throws OutputError where it can't be written, as all that follows.
  explicit BagWriter(const std::string& path) : file_(path), bag_(file_.path(), path) {}

  /// Writes a message of any type that ROS knows.
  /// @param time    of reception
  /// @param header  of the connection on which it came; without one its topic has one connection
  template <class M>
  void write(const std::string& topic, const ros::Time& time, const M& message,
             const boost::shared_ptr<ros::M_string>& header = nullptr) {
    const auto [known, is_new] = connections_.emplace(std::make_pair(topic, header), 0);
    if (is_new) {
      ros::M_string fields = header ? *header : ros::M_string();
      fields["topic"] = topic;
      fields["type"] = ros::message_traits::datatype(message);
      fields["md5sum"] = ros::message_traits::md5sum(message);
      fields["message_definition"] = ros::message_traits::definition(message);
      known->second = bag_.connection(fields);
    }
    bytes_.resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    ros::serialization::serialize(stream, message);
    bag_.write(known->second, time, bytes_);
  }

  /// To be called when all is written.
  void finish() {
    bag_.close();
    file_.finish();
  }

 private:
  OutputFile file_;
  BagFileWriter bag_;
  /// By topic and header, which is kept so that no other one takes its address.
  std::map<std::pair<std::string, boost::shared_ptr<ros::M_string>>, std::uint32_t> connections_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace sampled_data_observers
