#pragma once

#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <sampled_data_observers/GetEstimate.h>
#include <sampled_data_observers/Reset.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/ros/message_pool.h"
#include "sampled_data_observers/ros/observer_runtime.h"

namespace sampled_data_observers {

/// The nodelet of every observer type; each type derives from it and gives its name.
///
/// Private parameters: the configuration (read_parameter_tree()). Topics, services and what they
/// mean: doc/ros_interface.md. All callbacks run on the nodelet's single-threaded queue, so that no
/// lock is needed.
class ObserverNodelet : public nodelet::Nodelet {
 protected:
  /// @param type  the value that the key `observer` of the configuration must have
  explicit ObserverNodelet(std::string type) : type_(std::move(type)) {}

 private:
  /// @throws ConfigError for a bad configuration, after reporting it: the nodelet does not start.
  void onInit() override;

  void start(const ObserverConfig& config);
  /// What subscribes to a channel. Making it finds all faults of the channel's source.
  std::function<void()> subscription(const EventChannel& channel);
  void stop();
  void defer(std::function<void()> task);
  void run_deferred();
  void receive(const EventChannel& channel, const Event& event);
  void publish_due(const ros::TimerEvent&);
  void aim_timer(Stamp now);
  void watch_clock(Stamp now);
  bool reset(Reset::Request& request, Reset::Response& response);
  bool get_estimate(GetEstimate::Request& request, GetEstimate::Response& response);

  const std::string type_;
  std::unique_ptr<ObserverRuntime> runtime_;
  std::unique_ptr<MessagePool<StateEstimate>> estimates_;
  std::unique_ptr<MessagePool<EventStatus>> statuses_;
  Stamp last_now_ = 0;
  /// What came before the first time of a simulated clock.
  std::vector<std::function<void()>> deferred_;
  std::string reset_service_name_;

  ros::Publisher estimate_publisher_;
  ros::Publisher status_publisher_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Timer timer_;
};

}  // namespace sampled_data_observers
