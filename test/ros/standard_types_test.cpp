// An observer and a jump detector, live, that know nothing but messages of standard types.
#include <geometry_msgs/Point.h>
#include <geometry_msgs/TwistStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

class StandardTypesTest : public ::testing::Test {
 protected:
  StandardTypesTest() {
    beacon_ = handle_.advertise<geometry_msgs::Point>("beacon", 10);
    imu_ = handle_.advertise<sensor_msgs::Imu>("imu", 10);
    joints_ = handle_.advertise<sensor_msgs::JointState>("joint_states", 10);
    velocity_ = handle_.advertise<geometry_msgs::TwistStamped>("cmd_vel", 10);
    statuses_ = handle_.subscribe("events", 100, &StandardTypesTest::on_status, this);
    get_estimate_ = handle_.serviceClient<GetEstimate>("get_estimate");
  }

  bool connect() {
    return test::spin_until([this] {
      return get_estimate_.exists() && statuses_.getNumPublishers() > 0 &&
             beacon_.getNumSubscribers() == 1 && imu_.getNumSubscribers() == 2 &&
             joints_.getNumSubscribers() == 1 && velocity_.getNumSubscribers() == 1;
    });
  }

  ros::Time at(double seconds) const { return start_ + ros::Duration(seconds); }

  void send_imu(double seconds, double yaw, double acceleration, double norm = 1.0) {
    sensor_msgs::Imu message;
    message.header.stamp = at(seconds);
    message.orientation.z = norm * std::sin(yaw / 2.0);
    message.orientation.w = norm * std::cos(yaw / 2.0);
    message.linear_acceleration.z = acceleration;
    imu_.publish(message);
  }

  void send_joint(double seconds, const std::string& name, double position) {
    sensor_msgs::JointState message;
    message.header.stamp = at(seconds);
    message.name = {"other", name};
    message.position = {-1.0, position};
    joints_.publish(message);
  }

  /// The next statuses, in the order of their arrival.
  std::vector<EventStatus> receive(std::size_t count) {
    EXPECT_TRUE(test::spin_until([&] { return received_.size() >= count; }));
    return std::exchange(received_, {});
  }
  EventStatus receive() {
    const std::vector<EventStatus> statuses = receive(1);
    return statuses.empty() ? EventStatus() : statuses.front();
  }

  std::vector<double> state_at(const ros::Time& stamp) {
    GetEstimate call;
    call.request.stamp = stamp;
    EXPECT_TRUE(get_estimate_.call(call) && call.response.success) << call.response.message;
    return call.response.success ? call.response.estimate.state : std::vector<double>(2);
  }

  void on_status(const EventStatus::ConstPtr& message) { received_.push_back(*message); }

  ros::NodeHandle handle_;
  ros::Publisher beacon_;
  ros::Publisher imu_;
  ros::Publisher joints_;
  ros::Publisher velocity_;
  ros::Subscriber statuses_;
  ros::ServiceClient get_estimate_;
  const ros::Time start_ = ros::Time::now() - ros::Duration(5.0);
  std::vector<EventStatus> received_;
};

TEST_F(StandardTypesTest, EachIsReadAndTheJumpIsDetected) {
  ASSERT_TRUE(connect());

  send_joint(0.0, "wheel", 2.0);
  const EventStatus wheel = receive();
  EXPECT_EQ("wheel", wheel.source);
  EXPECT_EQ(EventStatus::USED, wheel.outcome);
  geometry_msgs::TwistStamped velocity;
  velocity.header.stamp = at(0.0);
  velocity.twist.linear.x = 1.0;
  velocity_.publish(velocity);
  EXPECT_EQ("input", receive().source);

  send_imu(1.0, 0.25, 9.75);
  EXPECT_EQ("heading", receive().source);
  send_imu(1.5, 0.25, 49.75);  // an impact: the signal goes from 0 to 40, through 20 halfway
  bool jumped = false;
  for (const EventStatus& status : receive(2)) {
    EXPECT_LE(status.outcome, EventStatus::USED_LATE) << status.reason;
    if (status.kind != EventStatus::JUMP) continue;
    EXPECT_EQ(at(1.25), status.header.stamp);
    jumped = true;
  }
  EXPECT_TRUE(jumped);
  const std::vector<double> before = state_at(at(1.25) - ros::Duration(0, 1));
  EXPECT_NEAR(3.25, before[0], 1e-8);
  EXPECT_NEAR(0.25, before[1], 1e-12);
  EXPECT_NEAR(0.75, state_at(at(1.25))[1], 1e-12);
  EXPECT_NEAR(0.25, state_at(at(1.5))[1], 1e-12);

  send_joint(1.6, "another", 2.0);
  const EventStatus lacking = receive();
  EXPECT_EQ(EventStatus::NO_FIELD, lacking.outcome);
  EXPECT_EQ(at(1.6), lacking.header.stamp);
  send_imu(1.7, 0.0, 9.75, 0.0);
  EXPECT_EQ(EventStatus::NOT_FINITE, receive().outcome);

  send_joint(2.0, "wheel", 7.0);
  send_joint(2.03, "wheel", 8.0);  // passed over
  send_joint(2.05, "wheel", 7.5);
  const std::vector<EventStatus> kept = receive(2);
  ASSERT_EQ(2u, kept.size());
  EXPECT_EQ(at(2.05), kept[1].header.stamp);

  const ros::Time sent = ros::Time::now();
  geometry_msgs::Point beacon;
  beacon.x = -3.0;
  beacon_.publish(beacon);
  const EventStatus stamped = receive();
  EXPECT_EQ(EventStatus::USED, stamped.outcome) << stamped.reason;
  EXPECT_GE(stamped.header.stamp, sent);
  EXPECT_LE(stamped.header.stamp, ros::Time::now());
  EXPECT_EQ(-3.0, state_at(stamped.header.stamp)[0]);
}

}  // namespace
}  // namespace sampled_data_observers
