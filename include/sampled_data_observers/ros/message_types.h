#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>

#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

template <class M>
struct MessageTag {
  using type = M;
};

/// @throws ConfigError that lists the message types that can be measured.
[[noreturn]] void refuse_type(const TopicSource& source);

/// Calls `visitor` with the MessageTag of the source's message type and returns what it returns.
/// This is the one place that knows which message types events can come from.
/// @throws ConfigError for a type that is not among them.
template <class Visitor>
auto visit_message_type(const TopicSource& source, Visitor&& visitor) {
  if (source.type == "sampled_data_observers/Measurement")
    return visitor(MessageTag<Measurement>{});
  if (source.type == "sampled_data_observers/Input") return visitor(MessageTag<Input>{});
  if (source.type == "sampled_data_observers/JumpEvent") return visitor(MessageTag<JumpEvent>{});
  if (source.type == "geometry_msgs/PointStamped") {
    return visitor(MessageTag<geometry_msgs::PointStamped>{});
  }
  if (source.type == "geometry_msgs/PoseStamped") {
    return visitor(MessageTag<geometry_msgs::PoseStamped>{});
  }
  refuse_type(source);
}

}  // namespace sampled_data_observers
