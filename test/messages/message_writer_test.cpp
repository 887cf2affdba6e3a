// Messages that are written for sources to read: what they find is what was to be found.
#include "messages/definition/message_writer.h"

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/NavSatFix.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Int32.h>
#include <std_msgs/Time.h>

#include <cmath>

#include "messages/simulated_messages.h"
#include "messages/source_reading.h"

namespace sampled_data_observers {
namespace {

using test::kStamp;
using test::source;

SimulatedMessage simulated(const std::vector<double>& values) {
  SimulatedMessage message;
  message.stamp = kStamp;
  message.values = values;
  return message;
}

/// What the type's own code makes of the message.
template <class M>
M written(const TopicSource& to, const std::vector<double>& values) {
  RawMessage raw = MessageEncoder({{to}}).encode(simulated(values));
  EXPECT_STREQ(ros::message_traits::MD5Sum<M>::value(), raw.said("md5sum"));
  EXPECT_STREQ(ros::message_traits::Definition<M>::value(), raw.said("message_definition"));
  M message;
  ros::serialization::IStream stream(raw.bytes.data(),
                                     static_cast<std::uint32_t>(raw.bytes.size()));
  ros::serialization::deserialize(stream, message);
  EXPECT_EQ(0u, stream.getLength());
  return message;
}

template <class M>
std::vector<double> read_back(const TopicSource& to, const std::vector<double>& values) {
  const auto messages =
      make_message_source(to, std::make_shared<TransformBuffer>(std::vector<StaticTransform>()));
  const test::Read read = test::read(*messages, written<M>(to, values));
  EXPECT_EQ(Reading::kEvent, read.reading);
  EXPECT_EQ(to.stamped_on_receipt ? test::kReceipt : kStamp, read.event.stamp);
  return read.values;
}

template <class M>
void expect_same(const std::vector<std::string>& fields, const std::vector<double>& values) {
  const std::vector<double> found = read_back<M>(source<M>(fields), values);
  ASSERT_EQ(values.size(), found.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_angle = fields[i].find("roll") != std::string::npos ||
                          fields[i].find("pitch") != std::string::npos ||
                          fields[i].find("yaw") != std::string::npos;
    EXPECT_NEAR(values[i], found[i], is_angle ? 1e-14 : 0.0) << fields[i];
  }
}

TEST(MessageWriterTest, WhatIsWrittenIsRead) {
  expect_same<nav_msgs::Odometry>({"pose.pose.position.x", "twist.twist.angular.z"}, {0.1, -3.0});
  expect_same<nav_msgs::Odometry>({"pose.pose.orientation.yaw", "pose.pose.orientation.roll",
                                   "pose.pose.orientation.pitch", "pose.covariance.35"},
                                  {2.5, -0.3, 1.2, 7.0});
  expect_same<sensor_msgs::Imu>({"orientation.z", "orientation.w"}, {0.6, 0.8});
  expect_same<sensor_msgs::JointState>({"position.right.wheel", "velocity.left"}, {1.5, 2.5});
  expect_same<sensor_msgs::LaserScan>({"ranges.3", "range_max"}, {1.5, 30.0});
  expect_same<sensor_msgs::NavSatFix>({"latitude"}, {47.5});
  expect_same<std_msgs::Int32>({"data"}, {-7.0});
}

TEST(MessageWriterTest, TheRestIsZeroAndQuaternionsAreTurnedByNothing) {
  TopicSource odometry = source<nav_msgs::Odometry>({"pose.pose.position.x"});
  odometry.frames.frame = "map";
  const auto message = written<nav_msgs::Odometry>(odometry, {4.0});
  EXPECT_EQ("map", message.header.frame_id);
  EXPECT_EQ(1.0, message.pose.pose.orientation.w);
  EXPECT_EQ(0.0, message.pose.pose.orientation.x);
  EXPECT_EQ(0.0, message.twist.twist.linear.x);
  EXPECT_EQ((std::vector<double>{4.0}), read_back<nav_msgs::Odometry>(odometry, {4.0}));
  const auto scan =
      written<sensor_msgs::LaserScan>(source<sensor_msgs::LaserScan>({"ranges.2"}), {1.0});
  EXPECT_EQ((std::vector<float>{0.0f, 0.0f, 1.0f}), scan.ranges);
}

TEST(MessageWriterTest, WholeNumbersAreRoundedAndKeptInTheirRange) {
  const auto rounded = [](double value) {
    return written<std_msgs::Int32>(source<std_msgs::Int32>({"data"}), {value}).data;
  };
  EXPECT_EQ(2, rounded(1.6));
  EXPECT_EQ(-2, rounded(-1.6));
  EXPECT_EQ(std::numeric_limits<std::int32_t>::max(), rounded(1e12));
  EXPECT_EQ(std::numeric_limits<std::int32_t>::min(), rounded(-1e12));
  EXPECT_EQ(std::numeric_limits<std::int32_t>::min(), rounded(std::nan("")));
  EXPECT_EQ(std::numeric_limits<std::int32_t>::max(), rounded(2147483647.0));
}

TEST(MessageWriterTest, BareStampsAreJumpsAndFieldsTheirModes) {
  TopicSource stamps = source<std_msgs::Time>({});
  stamps.of_jumps = true;
  stamps.stamped_on_receipt = false;
  EXPECT_EQ(kStamp, static_cast<Stamp>(written<std_msgs::Time>(stamps, {}).data.toNSec()));
  TopicSource modes = source<nav_msgs::Odometry>({"twist.twist.linear.x"});
  modes.of_jumps = modes.has_mode = true;
  modes.mode = "pose.pose.position.z";
  SimulatedMessage jump = simulated({0.5});
  jump.mode = 3;
  RawMessage raw = MessageEncoder({{modes}}).encode(jump);
  const auto messages = make_message_source(modes);
  Event event;
  event.kind = EventKind::kJump;
  messages->read(
      messages->deserialize(raw.bytes.data(), static_cast<std::uint32_t>(raw.bytes.size()),
                            raw.connection),
      test::kReceipt, event);
  EXPECT_EQ(3.0, event.mode);
  EXPECT_EQ(0.5, event.values[0]);
}

TEST(MessageWriterTest, WhatASourceCorrectsIsWrittenSoThatItDoes) {
  for (TopicSource to :
       {source<Measurement>({}),
        source<nav_msgs::Odometry>({"pose.pose.position.x", "pose.pose.position.y"})}) {
    to.size = 2;
    to.stamp_offset = 5'000'000;
    to.correction.scale = Eigen::Vector2d(2.0, -4.0);
    to.correction.offset = Eigen::Vector2d(1.0, 0.5);
    SimulatedChannel channel;
    channel.topic = "topic";
    channel.readings = {{to}};
    const SimulatedMessages messages({channel});
    const auto reader = make_message_source(to);
    int visits = 0;
    messages.visit(simulated({3.0, 8.5}), [&](const auto& message) {
      ++visits;
      const test::Read read = test::read(*reader, message);
      EXPECT_EQ((std::vector<double>{3.0, 8.5}), read.values) << to.type;
      EXPECT_EQ(kStamp, read.event.stamp) << to.type;
    });
    EXPECT_EQ(1, visits);
  }
}

}  // namespace
}  // namespace sampled_data_observers
