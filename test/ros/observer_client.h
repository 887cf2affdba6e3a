#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sampled_data_observers/EventStatus.h>
#include <sampled_data_observers/GetEstimate.h>
#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>
#include <sampled_data_observers/Reset.h>
#include <sampled_data_observers/StateEstimate.h>

#include <string>
#include <vector>

#include "ros/spin_until.h"

namespace sampled_data_observers::test {

/// What a robot's other nodes are to an observer configured by position.yaml: they publish events,
/// listen to what comes out, and call the services.
class ObserverClient {
 public:
  ObserverClient() {
    position_ = handle_.advertise<Measurement>("position", 100);
    input_ = handle_.advertise<Input>("input", 100);
    jumps_ = handle_.advertise<JumpEvent>("jumps", 100);
    estimate_subscriber_ = handle_.subscribe("estimate", 5000, &ObserverClient::on_estimate, this);
    status_subscriber_ = handle_.subscribe("events", 5000, &ObserverClient::on_status, this);
    reset_ = handle_.serviceClient<Reset>("reset");
    get_estimate_ = handle_.serviceClient<GetEstimate>("get_estimate");
  }

  bool connect() {
    return spin_until([this] {
      return reset_.exists() && get_estimate_.exists() && position_.getNumSubscribers() > 0 &&
             input_.getNumSubscribers() > 0 && jumps_.getNumSubscribers() > 0 &&
             estimate_subscriber_.getNumPublishers() > 0 &&
             status_subscriber_.getNumPublishers() > 0;
    });
  }

  static Measurement measurement(const ros::Time& stamp, const std::vector<double>& values) {
    Measurement message;
    message.header.stamp = stamp;
    message.values = values;
    return message;
  }

  /// Publishes a sample and waits for nothing.
  void publish_sample(const ros::Time& stamp, double value) {
    position_.publish(measurement(stamp, {value}));
  }

  /// Publishes a sample and returns the status that comes back for it; its source is empty when
  /// none comes.
  EventStatus sample(const ros::Time& stamp, const std::vector<double>& values) {
    return send(position_, measurement(stamp, values));
  }
  EventStatus input(const ros::Time& stamp, double u) {
    Input message;
    message.header.stamp = stamp;
    message.values = {u};
    return send(input_, message);
  }
  EventStatus jump(const ros::Time& stamp) {
    JumpEvent message;
    message.header.stamp = stamp;
    return send(jumps_, message);
  }

  GetEstimate::Response get_estimate(const ros::Time& stamp) {
    GetEstimate call;
    call.request.stamp = stamp;
    EXPECT_TRUE(get_estimate_.call(call));
    return call.response;
  }
  Reset::Response reset(const std::vector<double>& state) {
    Reset call;
    call.request.state = state;
    EXPECT_TRUE(reset_.call(call));
    return call.response;
  }

  std::vector<StateEstimate> estimates;
  std::vector<EventStatus> statuses;

 private:
  template <class M>
  EventStatus send(const ros::Publisher& publisher, const M& message) {
    const std::size_t before = statuses.size();
    publisher.publish(message);
    const bool came = spin_until([&] { return statuses.size() > before; });
    EXPECT_TRUE(came) << "no status on " << status_subscriber_.getTopic();
    return came ? statuses.back() : EventStatus();
  }
  void on_estimate(const StateEstimate::ConstPtr& message) { estimates.push_back(*message); }
  void on_status(const EventStatus::ConstPtr& message) { statuses.push_back(*message); }

  ros::NodeHandle handle_;
  ros::Publisher position_;
  ros::Publisher input_;
  ros::Publisher jumps_;
  ros::Subscriber estimate_subscriber_;
  ros::Subscriber status_subscriber_;
  ros::ServiceClient reset_;
  ros::ServiceClient get_estimate_;
};

}  // namespace sampled_data_observers::test
