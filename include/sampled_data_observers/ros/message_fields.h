#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>

#include <string>
#include <vector>

namespace sampled_data_observers {

/// A number in a message of type M and the path by which configurations name it.
template <class M>
struct MessageField {
  const char* path;
  double (*get)(const M&);
};

/// The fields of a standard message type that can be measured.
template <class M>
const std::vector<MessageField<M>>& message_fields();

template <>
const std::vector<MessageField<geometry_msgs::PointStamped>>& message_fields();

template <>
const std::vector<MessageField<geometry_msgs::PoseStamped>>& message_fields();

}  // namespace sampled_data_observers
