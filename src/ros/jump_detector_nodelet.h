#pragma once

#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "sampled_data_observers/messages/message_source.h"
#include "sampled_data_observers/ros/callback_threads.h"
#include "sampled_data_observers/ros/log_throttle.h"
#include "sampled_data_observers/ros/message_inbox.h"
#include "sampled_data_observers/ros/node_log.h"
#include "sampled_data_observers/runtime/event_outcome.h"

namespace sampled_data_observers {

/// Detects jumps of a plant in a signal, a field or formula of fields of any message type,
/// and publishes a JumpEvent on `jumps` for each.
///
/// Private parameters: the section `detector` of a configuration (read_parameter_tree()).
class JumpDetectorNodelet : public nodelet::Nodelet {
 public:
  JumpDetectorNodelet();
  ~JumpDetectorNodelet() override;

 private:
  /// @throws ConfigError for a bad configuration, after reporting it: the nodelet does not start.
  void onInit() override;
  void receive(const MessagePointer& message, Stamp receipt);

  std::optional<NodeLog> log_;
  /// For each outcome.
  std::array<LogThrottle, kEventOutcomes> throttles_;
  CallbackThreads threads_;
  std::unique_ptr<MessageSource> source_;
  std::string signal_topic_;
  std::optional<MessageInbox> messages_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace sampled_data_observers
