#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <ros/timer.h>
#include <sampled_data_observers/EventStatus.h>

#include <functional>
#include <string>
#include <vector>

#include "sampled_data_observers/ros/estimate_publication.h"
#include "sampled_data_observers/ros/message_pool.h"
#include "sampled_data_observers/ros/message_source.h"
#include "sampled_data_observers/ros/shared_runtime.h"

namespace sampled_data_observers {

/// Subscribes to the topics of all channels, gives their messages as events to the runtime, and
/// publishes what became of each. To be used on one callback queue of one thread.
class EventSubscriptions {
 public:
  /// Finds all faults of the channels' sources; subscribes to nothing before start().
  /// @param name  of the nodelet, for its log
  /// @throws ConfigError
  EventSubscriptions(const ros::NodeHandle& handle, const std::vector<EventChannel>& channels,
                     SharedRuntime& runtime, EstimatePublication& publication, std::string name);

  void start();

 private:
  std::function<void()> subscription(const EventChannel& channel);
  void defer(std::function<void()> task);
  void run_deferred();
  void receive(const EventChannel& channel, MessageSource& source, const MessagePointer& message,
               Stamp receipt);

  ros::NodeHandle handle_;
  SharedRuntime& runtime_;
  EstimatePublication& publication_;
  const std::string name_;
  MessagePool<EventStatus> statuses_;
  ros::Publisher status_publisher_;
  std::vector<std::function<void()>> subscribe_;
  std::vector<ros::Subscriber> subscribers_;
  /// What came before the first time of a simulated clock, and what ends the wait for it.
  std::vector<std::function<void()>> deferred_;
  ros::Timer clock_timer_;
};

}  // namespace sampled_data_observers
