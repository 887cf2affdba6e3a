#pragma once

#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>
#include <sampled_data_observers/StateEstimate.h>

#include <limits>

#include "messages/time_conversion.h"
#include "simulation/simulator.h"

namespace sampled_data_observers {

template <class M>
struct MessageTag {
  using type = M;
};

/// Calls `visitor` with the MessageTag of a channel's message type and returns what it returns.
template <class Visitor>
auto visit_simulated_type(const SimulatedChannel& channel, Visitor&& visitor) {
  switch (channel.kind) {
    case SimulatedChannel::Kind::kMeasurement:
    case SimulatedChannel::Kind::kSignal:
      return visitor(MessageTag<Measurement>{});
    case SimulatedChannel::Kind::kInput:
      return visitor(MessageTag<Input>{});
    case SimulatedChannel::Kind::kJump:
      return visitor(MessageTag<JumpEvent>{});
    case SimulatedChannel::Kind::kTruth:
      break;
  }
  return visitor(MessageTag<StateEstimate>{});
}

inline void fill(const SimulatedChannel&, const SimulatedMessage& from, Measurement& message) {
  message.values = from.values;
}

inline void fill(const SimulatedChannel&, const SimulatedMessage& from, Input& message) {
  message.values = from.values;
}

inline void fill(const SimulatedChannel&, const SimulatedMessage& from, JumpEvent& message) {
  message.mode = from.mode;
  message.values = from.values;
  message.release = to_ros_time(from.arrival);
}

inline void fill(const SimulatedChannel& channel, const SimulatedMessage& from,
                 StateEstimate& message) {
  message.names = channel.names;
  message.state = from.values;
  message.jumps = from.jumps;
  message.time_since_sample = std::numeric_limits<double>::quiet_NaN();
}

/// Calls `visitor` with the ROS message that a simulated one stands for.
template <class Visitor>
void visit_message(const SimulatedChannel& channel, const SimulatedMessage& from,
                   Visitor&& visitor) {
  visit_simulated_type(channel, [&](auto tag) {
    typename decltype(tag)::type message;
    message.header.stamp = to_ros_time(from.stamp);
    fill(channel, from, message);
    visitor(message);
  });
}

}  // namespace sampled_data_observers
