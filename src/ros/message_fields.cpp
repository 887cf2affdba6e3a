#include "sampled_data_observers/ros/message_fields.h"

namespace sampled_data_observers {

template <>
const std::vector<MessageField<geometry_msgs::PointStamped>>& message_fields() {
  using M = geometry_msgs::PointStamped;
  static const std::vector<MessageField<M>> kFields = {
      {"point.x", [](const M& message) { return message.point.x; }},
      {"point.y", [](const M& message) { return message.point.y; }},
      {"point.z", [](const M& message) { return message.point.z; }},
  };
  return kFields;
}

template <>
const std::vector<MessageField<geometry_msgs::PoseStamped>>& message_fields() {
  using M = geometry_msgs::PoseStamped;
  static const std::vector<MessageField<M>> kFields = {
      {"pose.position.x", [](const M& message) { return message.pose.position.x; }},
      {"pose.position.y", [](const M& message) { return message.pose.position.y; }},
      {"pose.position.z", [](const M& message) { return message.pose.position.z; }},
      {"pose.orientation.x", [](const M& message) { return message.pose.orientation.x; }},
      {"pose.orientation.y", [](const M& message) { return message.pose.orientation.y; }},
      {"pose.orientation.z", [](const M& message) { return message.pose.orientation.z; }},
      {"pose.orientation.w", [](const M& message) { return message.pose.orientation.w; }},
  };
  return kFields;
}

}  // namespace sampled_data_observers
