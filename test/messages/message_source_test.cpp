#include "sampled_data_observers/messages/message_source.h"

#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <std_msgs/Float64.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <limits>
#include <vector>

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

TEST(MessageSourceTest, AnUnknownTypeIsRefusedWithWhatToDo) {
  TopicSource other = source<std_msgs::Float64>({"data"});
  const auto fault_of_type = [&](const std::string& type) {
    other.type = type;
    return fault_of([&] { make_message_source(other); });
  };
  expect_parts(fault_of_type("no_such_msgs/Wheel"),
               {"file.yaml:3", "sensors/s/source/type", "'no_such_msgs/Wheel'",
                "rospack finds no package no_such_msgs", "setup.bash", "ros-no-such-msgs"});
  expect_parts(fault_of_type("geometry_msgs/PoseStampt"),
               {"'geometry_msgs/PoseStampt'", "did you mean geometry_msgs/PoseStamped?",
                "geometry_msgs has Accel, AccelStamped"});
  expect_parts(fault_of_type("sensor_msgs/IMU"), {"did you mean sensor_msgs/Imu?"});
  for (const char* type : {"Float64", "std_msgs/", "/Float64", "std_msgs/Float/64", "a b/c"}) {
    expect_parts(fault_of_type(type), {"is no name of a type, package/Type"});
  }
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

TEST(MessageSourceTest, WhatIsCutOffOrGoesOnIsMalformed) {
  const auto points = make_message_source(source<geometry_msgs::PointStamped>({"point.y"}));
  geometry_msgs::PointStamped message;
  message.header.stamp.fromNSec(kStamp);
  message.header.frame_id = "map";
  message.point.y = 2.5;
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  const auto size = static_cast<std::uint32_t>(bytes.num_bytes - 4);
  for (std::uint32_t length = 0; length <= size + 1; ++length) {
    std::vector<std::uint8_t> copy(bytes.message_start,
                                   bytes.message_start + std::min(length, size));
    copy.resize(length);  // a sanitizer sees what is read behind it
    Event event;
    const Reading reading =
        points->read(points->deserialize(copy.data(), length, nullptr), kReceipt, event);
    EXPECT_EQ(length == size ? Reading::kEvent : Reading::kMalformed, reading) << length;
    if (length != size) continue;
    EXPECT_EQ(2.5, event.values[0]);
  }
  EXPECT_EQ(EventOutcome::kMalformed, outcome_of(Reading::kMalformed));
}

TEST(MessageSourceTest, AnotherDefinitionIsNotRead) {
  const auto points = make_message_source(source<geometry_msgs::PointStamped>({"point.y"}));
  geometry_msgs::PointStamped message;
  message.header.stamp.fromNSec(kStamp);
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  const auto connection = boost::make_shared<ros::M_string>();
  const auto reading = [&] {
    Event event;
    const MessagePointer received = points->deserialize(
        bytes.message_start, static_cast<std::uint32_t>(bytes.num_bytes - 4), connection);
    const Reading found = points->read(received, kReceipt, event);
    EXPECT_EQ(found == Reading::kEvent ? kStamp : 0, points->stamp_of(received, kReceipt));
    return found;
  };
  (*connection)["type"] = "geometry_msgs/PointStamped";
  (*connection)["md5sum"] = ros::message_traits::MD5Sum<geometry_msgs::PointStamped>::value();
  EXPECT_EQ(Reading::kEvent, reading());
  (*connection)["md5sum"] = ros::message_traits::MD5Sum<geometry_msgs::Vector3Stamped>::value();
  EXPECT_EQ(Reading::kOtherDefinition, reading());
  (*connection)["md5sum"] = ros::message_traits::MD5Sum<geometry_msgs::PointStamped>::value();
  (*connection)["type"] = "its/PointStamped";
  EXPECT_EQ(Reading::kOtherDefinition, reading());
  EXPECT_EQ(EventOutcome::kOtherDefinition, outcome_of(Reading::kOtherDefinition));
  (*connection)["callerid"] = "/camera";
  const std::string sum = ros::message_traits::MD5Sum<geometry_msgs::PointStamped>::value();
  EXPECT_EQ(sum, points->md5sum());
  EXPECT_EQ("/camera on topic has its/PointStamped, MD5 sum " + sum +
                "; expected geometry_msgs/PointStamped, " + sum,
            points->describe_sender(points->deserialize(bytes.message_start, 0, connection)));
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

TEST(MessageSourceTest, AnOffsetOfStampsIsAddedToAllThatThereAre) {
  geometry_msgs::PointStamped message;
  message.header.stamp = to_ros_time(test::kStamp);
  TopicSource source = test::source<geometry_msgs::PointStamped>({"point.x"});
  source.stamp_offset = -3'100'000'000;
  const std::unique_ptr<MessageSource> messages = make_message_source(source);
  EXPECT_EQ(test::kStamp - 3'100'000'000, test::read(*messages, message).event.stamp);
  message.header.stamp = ros::Time();
  EXPECT_EQ(0, test::read(*messages, message).event.stamp);
  source.stamped_on_receipt = true;
  EXPECT_EQ(test::kReceipt - 3'100'000'000,
            test::read(*make_message_source(source), message).event.stamp);
}

TEST(MessageSourceTest, ValuesAreScaledMovedAndKeptWithinLimits) {
  geometry_msgs::PointStamped message;
  message.header.stamp = to_ros_time(test::kStamp);
  message.point.x = 3.0;
  message.point.y = -8.0;
  TopicSource source = test::source<geometry_msgs::PointStamped>({"point.x", "point.y"});
  source.correction.scale = Eigen::Vector2d(2.0, 0.25);
  source.correction.offset = Eigen::Vector2d(-1.0, 0.5);
  source.correction.limits = {{4.0, 6.0}, {-1.5, 0.0}};
  source.min_interval = kNanosecondsPerSecond;
  const std::unique_ptr<MessageSource> messages = make_message_source(source);
  message.point.x = 3.6;
  EXPECT_EQ(Reading::kOutOfLimits, test::read(*messages, message).reading);
  EXPECT_EQ(EventOutcome::kOutOfLimits, outcome_of(Reading::kOutOfLimits));
  // It does not take the place of the next one.
  message.point.x = 3.0;
  const test::Read read = test::read(*messages, message);
  EXPECT_EQ(Reading::kEvent, read.reading);
  EXPECT_EQ((std::vector<double>{5.0, -1.5}), read.values);
  message.point.x = std::numeric_limits<double>::quiet_NaN();  // whoever takes events rejects it
  EXPECT_EQ(Reading::kEvent, test::read(*messages, message).reading);
  const MessagePointer sent = test::sent(*messages, message);
  Event event;
  const std::size_t before = test::allocations();
  messages->read(sent, test::kReceipt, event);
  EXPECT_EQ(before, test::allocations());
}

TEST(MessageSourceTest, ReadingAllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const auto joint = make_message_source(
      source<sensor_msgs::JointState>({"position.a_rather_long_name", "velocity.second"}));
  const auto odometry = make_message_source(
      source<nav_msgs::Odometry>({"pose.pose.position.x", "pose.pose.orientation.yaw"}));
  const auto scan = make_message_source(source<sensor_msgs::LaserScan>({"ranges.2"}));
  sensor_msgs::JointState joints;
  joints.header.frame_id = "a_frame_of_a_rather_long_name";
  joints.name = {"second", "a_rather_long_name"};
  joints.position = joints.velocity = {1.0, 2.0};
  sensor_msgs::LaserScan distances;
  distances.ranges = {1.0f, 2.0f, 3.0f};
  const MessagePointer sent_joints = test::sent(*joint, joints);
  const MessagePointer sent_pose = test::sent(*odometry, nav_msgs::Odometry());
  const MessagePointer sent_scan = test::sent(*scan, distances);
  Event event;
  const std::size_t before = test::allocations();
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(Reading::kEvent, joint->read(sent_joints, kReceipt, event));
    EXPECT_EQ(Reading::kEvent, odometry->read(sent_pose, kReceipt, event));
    EXPECT_EQ(Reading::kEvent, scan->read(sent_scan, kReceipt, event));
    scan->stamp_of(sent_scan, kReceipt);
  }
  EXPECT_EQ(before, test::allocations());
}

}  // namespace
}  // namespace sampled_data_observers
