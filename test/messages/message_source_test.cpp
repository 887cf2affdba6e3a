#include "sampled_data_observers/messages/message_source.h"

#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>

#include <cmath>

#include "messages/source_reading.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::expect_parts;
using test::fault_of;
using test::kReceipt;
using test::kStamp;
using test::read;
using test::source;

TEST(MessageSourceTest, AnUnknownTypeIsRefusedWithAListOfThoseThatExist) {
  TopicSource other = source<std_msgs::Float64>({"data"});
  other.type = "std_msgs/String";
  const std::string message = fault_of([&] { make_message_source(other); });
  expect_parts(message, {"file.yaml:3", "sensors/s/source/type", "'std_msgs/String'",
                         "sampled_data_observers/Measurement", "geometry_msgs/PoseStamped",
                         "sensor_msgs/JointState"});
}

TEST(MessageSourceTest, ATopicMustHaveANameOfROS) {
  TopicSource other = source<geometry_msgs::Point>({"x"});
  other.topic = "two words";
  expect_parts(fault_of([&] { make_message_source(other); }),
               {"sensors/s/source/topic", "'two words'"});
}

TEST(MessageSourceTest, FieldsAreRequired) {
  const std::string message =
      fault_of([] { make_message_source(source<geometry_msgs::PointStamped>({})); });
  expect_parts(message, {"sensors/s/source/fields", "point.x, point.y, point.z", "found none"});
}

TEST(MessageSourceTest, ATypeWithoutStampNeedsOneByReceipt) {
  TopicSource number = source<std_msgs::Float64>({"data"});
  number.stamped_on_receipt = false;
  expect_parts(fault_of([&] { make_message_source(number); }),
               {"sensors/s/source/stamp", "receipt", "std_msgs/Float64 carries no stamp"});
}

TEST(MessageSourceTest, DeserializesWhatRoscppSends) {
  const auto points = make_message_source(source<geometry_msgs::PointStamped>({"point.y"}));
  EXPECT_STREQ(ros::message_traits::MD5Sum<geometry_msgs::PointStamped>::value(), points->md5sum());
  geometry_msgs::PointStamped message;
  message.point.y = 2.5;
  ros::SerializedMessage sent = ros::serialization::serializeMessage(message);
  const auto size = static_cast<std::uint32_t>(sent.num_bytes - 4);  // without the length
  Event event;
  points->read(points->deserialize(sent.message_start, size), kReceipt, event);
  EXPECT_EQ(2.5, event.values[0]);
  EXPECT_THROW(points->deserialize(sent.message_start, size - 1), ros::Exception);
}

TEST(MessageSourceTest, ReceiptReplacesAStampWhereConfigured) {
  TopicSource point = source<geometry_msgs::PointStamped>({"point.x"});
  point.stamped_on_receipt = true;
  geometry_msgs::PointStamped message;
  message.header.stamp.fromNSec(kStamp);
  EXPECT_EQ(kReceipt, read(*make_message_source(point), message).event.stamp);
}

TEST(MessageSourceTest, AMinimumIntervalThinsByStamps) {
  TopicSource thinned = source<geometry_msgs::PointStamped>({"point.x"});
  thinned.min_interval = 100;
  const auto points = make_message_source(thinned);
  const auto reading = [&](Stamp stamp, double x = 0.0) {
    geometry_msgs::PointStamped message;
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
    message.point.x = x;
    return read(*points, message).reading;
  };
  EXPECT_EQ(Reading::kEvent, reading(1000, std::nan("")));  // rejected, so it does not count
  EXPECT_EQ(Reading::kEvent, reading(1050));
  EXPECT_EQ(Reading::kPassedOver, reading(1050));
  EXPECT_EQ(Reading::kPassedOver, reading(1149));
  EXPECT_EQ(Reading::kEvent, reading(1150));
  EXPECT_EQ(Reading::kPassedOver, reading(1051));  // late
  EXPECT_EQ(Reading::kEvent, reading(500));        // the clock was set back
  EXPECT_EQ(Reading::kEvent, reading(600));
}

TEST(MessageSourceTest, ReadingAllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const auto joint = make_message_source(
      source<sensor_msgs::JointState>({"position.a_rather_long_name", "velocity.second"}));
  const auto odometry = make_message_source(
      source<nav_msgs::Odometry>({"pose.pose.position.x", "pose.pose.orientation.yaw"}));
  const auto joints = boost::make_shared<sensor_msgs::JointState>();
  joints->name = {"second", "a_rather_long_name"};
  joints->position = joints->velocity = {1.0, 2.0};
  const auto pose_and_twist = boost::make_shared<nav_msgs::Odometry>();
  Event event;
  const std::size_t before = test::allocations();
  for (int i = 0; i < 10; ++i) {
    joint->read(joints, kReceipt, event);
    odometry->read(pose_and_twist, kReceipt, event);
  }
  EXPECT_EQ(before, test::allocations());
}

}  // namespace
}  // namespace sampled_data_observers
