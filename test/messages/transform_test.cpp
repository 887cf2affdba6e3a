// Messages in other frames, against closed forms.
#include <gtest/gtest.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <string>

#include "messages/message_transformer.h"
#include "messages/time_conversion.h"
#include "messages/transform_message.h"
#include "sampled_data_observers/messages/transform_buffer.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;

const double kPi = std::acos(-1.0);

/// A quarter turn to the left, two ahead and one up.
Eigen::Isometry3d quarter_turn() {
  Eigen::Isometry3d transform(Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitZ()));
  transform.translation() << 2.0, 0.0, 1.0;
  return transform;
}

/// Nothing special about it.
Eigen::Isometry3d some_transform() {
  Eigen::Isometry3d transform(Eigen::Quaterniond(0.5, -0.1, 0.7, 0.3).normalized());
  transform.translation() << 0.3, -1.2, 2.5;
  return transform;
}

template <class V>
V made(double x, double y, double z) {
  V result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

geometry_msgs::Quaternion rotation(const Eigen::Quaterniond& from) {
  geometry_msgs::Quaternion result;
  result.w = from.w();
  result.x = from.x();
  result.y = from.y();
  result.z = from.z();
  return result;
}

geometry_msgs::Quaternion about_z(double angle) {
  return rotation(Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())));
}

double yaw(const geometry_msgs::Quaternion& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

template <class V>
void expect_near(double x, double y, double z, const V& found) {
  EXPECT_NEAR(x, found.x, 1e-12);
  EXPECT_NEAR(y, found.y, 1e-12);
  EXPECT_NEAR(z, found.z, 1e-12);
}

template <class V, class W>
void expect_near(const V& expected, const W& found) {
  expect_near(expected.x, expected.y, expected.z, found);
}

TEST(TransformMessageTest, PointsAreRotatedAndMoved) {
  geometry_msgs::PointStamped message;
  message.point = made<geometry_msgs::Point>(1, 0, 0);
  to_frame(quarter_turn(), message);
  expect_near(2, 1, 1, message.point);
}

TEST(TransformMessageTest, VectorsAreRotatedOnly) {
  geometry_msgs::Vector3Stamped vector;
  vector.vector = made<geometry_msgs::Vector3>(1, 2, 3);
  to_frame(quarter_turn(), vector);
  expect_near(-2, 1, 3, vector.vector);
  sensor_msgs::MagneticField field;
  field.magnetic_field = made<geometry_msgs::Vector3>(1, 2, 3);
  to_frame(quarter_turn(), field);
  expect_near(-2, 1, 3, field.magnetic_field);
  geometry_msgs::AccelStamped accel;
  accel.accel.linear = made<geometry_msgs::Vector3>(1, 0, 0);
  accel.accel.angular = made<geometry_msgs::Vector3>(0, 1, 0);
  to_frame(quarter_turn(), accel);
  expect_near(0, 1, 0, accel.accel.linear);
  expect_near(-1, 0, 0, accel.accel.angular);
}

TEST(TransformMessageTest, PosesOfAllTypesAreTransformedAlike) {
  const auto position = made<geometry_msgs::Point>(1, 0, 0);
  geometry_msgs::PoseStamped pose;
  pose.pose.position = position;
  pose.pose.orientation = about_z(0.5);
  geometry_msgs::PoseWithCovarianceStamped uncertain;
  uncertain.pose.pose = pose.pose;
  nav_msgs::Odometry odometry;
  odometry.pose.pose = pose.pose;
  odometry.twist.twist.linear = made<geometry_msgs::Vector3>(1, 2, 3);
  geometry_msgs::TransformStamped transform;
  transform.transform.translation = made<geometry_msgs::Vector3>(1, 0, 0);
  transform.transform.rotation = pose.pose.orientation;
  to_frame(quarter_turn(), pose);
  to_frame(quarter_turn(), uncertain);
  to_frame(quarter_turn(), odometry);
  to_frame(quarter_turn(), transform);
  expect_near(2, 1, 1, pose.pose.position);
  expect_near(2, 1, 1, uncertain.pose.pose.position);
  expect_near(2, 1, 1, odometry.pose.pose.position);
  expect_near(2, 1, 1, transform.transform.translation);
  for (const geometry_msgs::Quaternion& q :
       {pose.pose.orientation, uncertain.pose.pose.orientation, odometry.pose.pose.orientation,
        transform.transform.rotation}) {
    EXPECT_NEAR(0.5 + kPi / 2.0, yaw(q), 1e-12);
  }
  // The twist is the child's affair.
  expect_near(1, 2, 3, odometry.twist.twist.linear);
}

TEST(TransformMessageTest, TheVelocityIsThatOfTheOtherPoint) {
  // A sensor 2 m ahead of the body's origin, turned to the left; the body turns at 0.5 rad/s and
  // drives at 3 m/s: the sensor feels 3 ahead and 0.5 * 2 to the left.
  Eigen::Isometry3d sensor = quarter_turn();
  sensor.translation().z() = 0.0;
  geometry_msgs::TwistStamped message;
  message.twist.angular = made<geometry_msgs::Vector3>(0, 0, 0.5);
  message.twist.linear = made<geometry_msgs::Vector3>(1, -3, 0);
  geometry_msgs::TwistWithCovarianceStamped uncertain;
  uncertain.twist.twist = message.twist;
  to_frame(sensor, message);
  to_frame(sensor, uncertain);
  for (const geometry_msgs::Twist& twist : {message.twist, uncertain.twist.twist}) {
    expect_near(0, 0, 0.5, twist.angular);
    expect_near(3, 0, 0, twist.linear);
  }
}

TEST(TransformMessageTest, TheTorqueIsThatAboutTheOtherPoint) {
  // 10 N upward, 2 m ahead, pitch the body up: negative about y.
  Eigen::Isometry3d sensor = quarter_turn();
  geometry_msgs::WrenchStamped message;
  message.wrench.force = made<geometry_msgs::Vector3>(0, 0, 10);
  message.wrench.torque = made<geometry_msgs::Vector3>(1, 0, 0);
  to_frame(sensor, message);
  expect_near(0, 0, 10, message.wrench.force);
  expect_near(0, 1 - 20, 0, message.wrench.torque);
}

TEST(TransformMessageTest, TwistsAndWrenchesGiveTheSamePowerInEveryFrame) {
  geometry_msgs::TwistStamped twist;
  twist.twist.linear = made<geometry_msgs::Vector3>(0.3, -2.0, 1.0);
  twist.twist.angular = made<geometry_msgs::Vector3>(1.5, 0.4, -0.7);
  geometry_msgs::WrenchStamped wrench;
  wrench.wrench.force = made<geometry_msgs::Vector3>(-5.0, 3.0, 2.0);
  wrench.wrench.torque = made<geometry_msgs::Vector3>(0.2, 8.0, -1.0);
  const auto power = [&] {
    const geometry_msgs::Vector3& v = twist.twist.linear;
    const geometry_msgs::Vector3& w = twist.twist.angular;
    const geometry_msgs::Vector3& f = wrench.wrench.force;
    const geometry_msgs::Vector3& t = wrench.wrench.torque;
    return v.x * f.x + v.y * f.y + v.z * f.z + w.x * t.x + w.y * t.y + w.z * t.z;
  };
  const double before = power();
  to_frame(some_transform(), twist);
  to_frame(some_transform(), wrench);
  EXPECT_NEAR(before, power(), 1e-12);
}

TEST(TransformMessageTest, AnImuSaysWhatTheBodyDoes) {
  // The Husky's: turned by a quarter about x, then about the body's z backward.
  Eigen::Isometry3d imu(Eigen::AngleAxisd(-kPi / 2.0, Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitX()));
  imu.translation() << 0.0, -0.3, 0.52;
  const double heading = 0.8;
  sensor_msgs::Imu message;
  message.orientation = rotation(
      Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) * imu.linear()));
  // Its y axis points up, its x axis to the right, and its z axis backward.
  message.angular_velocity = made<geometry_msgs::Vector3>(0, 0.25, 0);
  message.linear_acceleration = made<geometry_msgs::Vector3>(-0.5, 9.81, -2);
  to_frame(imu, message);
  EXPECT_NEAR(heading, yaw(message.orientation), 1e-12);
  expect_near(0, 0, 0.25, message.angular_velocity);
  expect_near(2, 0.5, 9.81, message.linear_acceleration);
}

TEST(TransformMessageTest, ThePoseOfASensorBecomesThatOfTheBody) {
  // The sensor is 2 m ahead of the body, 1 m above it, and looks to the left.
  const Eigen::Isometry3d body_in_sensor = quarter_turn().inverse();
  geometry_msgs::PoseStamped pose;
  pose.pose.position = made<geometry_msgs::Point>(10, 7, 1);
  pose.pose.orientation = about_z(kPi);  // so the body looks along y
  geometry_msgs::PoseWithCovarianceStamped uncertain;
  uncertain.pose.pose = pose.pose;
  geometry_msgs::TransformStamped transform;
  transform.transform.translation = made<geometry_msgs::Vector3>(10, 7, 1);
  transform.transform.rotation = pose.pose.orientation;
  to_body(body_in_sensor, pose);
  to_body(body_in_sensor, uncertain);
  to_body(body_in_sensor, transform);
  expect_near(10, 5, 0, pose.pose.position);
  expect_near(10, 5, 0, uncertain.pose.pose.position);
  expect_near(10, 5, 0, transform.transform.translation);
  for (const geometry_msgs::Quaternion& q :
       {pose.pose.orientation, uncertain.pose.pose.orientation, transform.transform.rotation}) {
    EXPECT_NEAR(kPi / 2.0, yaw(q), 1e-12);
  }
}

TEST(TransformMessageTest, OdometryOfASensorBecomesThatOfTheBody) {
  const Eigen::Isometry3d sensor = some_transform();
  nav_msgs::Odometry message;
  message.pose.pose.position = made<geometry_msgs::Point>(10, 7, 1);
  message.pose.pose.orientation = about_z(0.3);
  message.twist.twist.linear = made<geometry_msgs::Vector3>(0.3, -2.0, 1.0);
  message.twist.twist.angular = made<geometry_msgs::Vector3>(1.5, 0.4, -0.7);
  geometry_msgs::PoseStamped pose;
  pose.pose = message.pose.pose;
  geometry_msgs::TwistStamped twist;
  twist.twist = message.twist.twist;
  to_body(sensor.inverse(), message);
  to_body(sensor.inverse(), pose);
  to_frame(sensor, twist);
  expect_near(pose.pose.position, message.pose.pose.position);
  expect_near(twist.twist.linear, message.twist.twist.linear);
  expect_near(twist.twist.angular, message.twist.twist.angular);
}

TEST(TransformMessageTest, APoseWithoutOrientationHasNoBody) {
  geometry_msgs::PoseStamped message;  // its quaternion is all zeros
  to_body(quarter_turn(), message);
  EXPECT_TRUE(std::isnan(message.pose.position.x));
}

tf2_msgs::TFMessage tf(const std::string& frame, const std::string& child, double seconds, double x,
                       double angle = 0.0) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time(seconds);
  transform.header.frame_id = frame;
  transform.child_frame_id = child;
  transform.transform.translation.x = x;
  transform.transform.rotation = about_z(angle);
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  return message;
}

StaticTransform static_transform(const std::string& frame, const std::string& child, double x) {
  StaticTransform transform;
  transform.frame = frame;
  transform.child_frame = child;
  transform.translation.x() = x;
  return transform;
}

TEST(TransformBufferTest, StaticTransformsHoldAtAllTimes) {
  StaticTransform husky = static_transform("base_link", "imu_link", 0.0);
  husky.translation << 0.0, -0.3, 0.52;
  husky.rotation << kPi / 2.0, 0.0, -kPi / 2.0;
  TransformBuffer buffer({husky});
  const auto found = buffer.find("base_link", "imu_link", 7);
  ASSERT_TRUE(found);
  Eigen::Matrix3d expected;
  expected << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  EXPECT_TRUE(found->linear().isApprox(expected, 1e-12)) << found->linear();
  EXPECT_EQ(Eigen::Vector3d(0.0, -0.3, 0.52), found->translation());
  buffer.clear();
  EXPECT_TRUE(buffer.find("base_link", "imu_link", 7));
  const auto inverse = buffer.find("imu_link", "base_link", 900 * kSecond);
  ASSERT_TRUE(inverse);
  EXPECT_TRUE((*inverse * *found).isApprox(Eigen::Isometry3d::Identity(), 1e-12));
}

TEST(TransformBufferTest, MovingTransformsAreInterpolatedAndNeverExtrapolated) {
  TransformBuffer buffer({});
  EXPECT_FALSE(buffer.find("map", "camera", kSecond));
  buffer.take(tf("map", "camera", 1.0, 4.0, 0.0), false, kSecond);
  EXPECT_FALSE(buffer.find("map", "camera", kSecond + 1));
  buffer.take(tf("map", "camera", 2.0, 6.0, 1.0), false, kSecond);
  const auto between = buffer.find("map", "/camera", kSecond + kSecond / 4);
  ASSERT_TRUE(between);
  EXPECT_NEAR(4.5, between->translation().x(), 1e-12);
  EXPECT_NEAR(0.25, std::atan2(between->linear()(1, 0), between->linear()(0, 0)), 1e-12);
  EXPECT_FALSE(buffer.find("map", "camera", 2 * kSecond + 1));
  EXPECT_FALSE(buffer.find("map", "camera", kSecond - 1));
  EXPECT_FALSE(buffer.find("map", "", 2 * kSecond));
  buffer.clear();
  EXPECT_FALSE(buffer.find("map", "camera", 2 * kSecond));
}

TEST(TransformBufferTest, ATransformFromFarAheadDoesNotTakeThePlaceOfThePresentOnes) {
  TransformBuffer buffer({});
  buffer.take(tf("map", "camera", 1000.0, 4.0), false, kSecond);
  buffer.take(tf("map", "camera", 1.0, 5.0), false, kSecond);
  ASSERT_TRUE(buffer.find("map", "camera", kSecond));
  EXPECT_FALSE(buffer.find("map", "camera", 1000 * kSecond));
}

TEST(TransformBufferTest, BeforeASimulatedClockBeginsNoneIsFromFarAhead) {
  TransformBuffer buffer({});
  buffer.take(tf("map", "camera", 1000.0, 4.0), false, 0);
  EXPECT_TRUE(buffer.find("map", "camera", 1000 * kSecond));
}

TEST(TransformBufferTest, TheConfigurationOverrulesTheTopics) {
  TransformBuffer buffer({static_transform("base_link", "camera", 1.0)});
  buffer.take(tf("base_link", "/camera", 1.0, 5.0), true, kSecond);
  buffer.take(tf("base_link", "laser", 1.0, 6.0), true, kSecond);
  EXPECT_EQ(1.0, buffer.find("base_link", "camera", kSecond)->translation().x());
  EXPECT_EQ(6.0, buffer.find("base_link", "laser", 50 * kSecond)->translation().x());
}

TopicSource source(const std::string& type, const SourceFrames& frames) {
  TopicSource result;
  result.type = type;
  result.origin = "file.yaml:3";
  result.path = "sensors/s/source";
  result.frames = frames;
  return result;
}

template <class M>
std::string fault(const SourceFrames& frames) {
  try {
    MessageTransformer<M> transformer(source("its/Type", frames));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(MessageTransformerTest, RefusesFramesThatATypeHasNoUseFor) {
  const SourceFrames frame{"map", "", "", 0};
  const SourceFrames body{"", "base_link", "", 0};
  const SourceFrames sensor{"", "base_link", "camera", 0};
  EXPECT_NE(std::string::npos, fault<sensor_msgs::JointState>(frame).find(
                                   "file.yaml:3: sensors/s/source/frame: expected none (nothing in "
                                   "its/Type depends on a frame), found 'map'"));
  EXPECT_NE(std::string::npos,
            fault<geometry_msgs::PointStamped>(body).find("source/body_frame: expected none"));
  EXPECT_NE(std::string::npos, fault<geometry_msgs::PoseStamped>(body).find(
                                   "source/sensor_frame: expected the frame"));
  EXPECT_EQ("no fault", fault<geometry_msgs::PoseStamped>(sensor));
  EXPECT_EQ("no fault", fault<nav_msgs::Odometry>(body));
  EXPECT_EQ("no fault", fault<sensor_msgs::Imu>(frame));
  EXPECT_EQ("no fault", fault<sensor_msgs::JointState>({}));
}

TEST(MessageTransformerTest, TransformsAtTheStampOnceTheTransformIsKnown) {
  TransformBuffer buffer({});
  MessageTransformer<geometry_msgs::PointStamped> transformer(
      source("geometry_msgs/PointStamped", {"map", "", "", 0}));
  geometry_msgs::PointStamped message;
  message.header.frame_id = "camera";
  message.point.x = 1.0;
  const Stamp stamp = kSecond + kSecond / 2;
  buffer.take(tf("map", "camera", 1.0, 4.0), false, kSecond);
  EXPECT_EQ(nullptr, transformer.transform(message, stamp, &buffer));
  buffer.take(tf("map", "camera", 2.0, 6.0), false, kSecond);
  const geometry_msgs::PointStamped* transformed = transformer.transform(message, stamp, &buffer);
  ASSERT_NE(nullptr, transformed);
  EXPECT_NEAR(6.0, transformed->point.x, 1e-12);
  EXPECT_EQ(1.0, message.point.x);
}

TEST(MessageTransformerTest, FindsTheSensorOfABodyInTheMessageOrTheConfiguration) {
  TransformBuffer buffer(
      {static_transform("base_link", "camera", 1.0), static_transform("base_link", "tag", 2.0)});
  nav_msgs::Odometry message;
  message.header.frame_id = "odom";
  message.child_frame_id = "camera";
  message.pose.pose.orientation.w = 1.0;
  for (const auto& [sensor, expected] : {std::pair<const char*, double>{"", -1.0}, {"tag", -2.0}}) {
    MessageTransformer<nav_msgs::Odometry> transformer(
        source("nav_msgs/Odometry", {"", "base_link", sensor, 0}));
    const nav_msgs::Odometry* transformed = transformer.transform(message, kSecond, &buffer);
    ASSERT_NE(nullptr, transformed);
    EXPECT_NEAR(expected, transformed->pose.pose.position.x, 1e-12);
  }
}

TEST(MessageTransformerTest, WithoutFramesTheMessageIsItself) {
  MessageTransformer<sensor_msgs::JointState> transformer(source("sensor_msgs/JointState", {}));
  const sensor_msgs::JointState message;
  EXPECT_EQ(&message, transformer.transform(message, kSecond, nullptr));
}

}  // namespace
}  // namespace sampled_data_observers
