// Messages in other frames, against closed forms.
#include <geometry_msgs/AccelStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MagneticField.h>

#include <cmath>
#include <string>

#include "messages/source_reading.h"
#include "messages/time_conversion.h"
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

/// A message read in other frames.
template <class M>
class Transformed {
 public:
  /// @param frames  `frame` or `body_frame`, or both
  Transformed(const SourceFrames& frames, const Eigen::Isometry3d& pose, M message)
      : frames_(frames), message_(std::move(message)) {
    message_.header.frame_id = "F";
    message_.header.stamp = to_ros_time(kSecond);
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "G";
    transform.child_frame_id = "F";
    transform.transform.translation = made<geometry_msgs::Vector3>(
        pose.translation().x(), pose.translation().y(), pose.translation().z());
    transform.transform.rotation = rotation(Eigen::Quaterniond(pose.linear()));
    tf2_msgs::TFMessage all;
    all.transforms = {transform};
    const bool is_static = true;
    transforms_->take(all, is_static, kSecond);
  }

  double operator()(const std::string& field) const {
    TopicSource source = test::source<M>({field});
    source.frames = frames_;
    const auto messages = make_message_source(source, transforms_);
    const test::Read read = test::read(*messages, message_);
    EXPECT_EQ(Reading::kEvent, read.reading) << field;
    return read.values.empty() ? std::nan("") : read.values[0];
  }

  void expect_near(double x, double y, double z, const std::string& vector) const {
    EXPECT_NEAR(x, (*this)(vector + ".x"), 1e-12) << vector;
    EXPECT_NEAR(y, (*this)(vector + ".y"), 1e-12) << vector;
    EXPECT_NEAR(z, (*this)(vector + ".z"), 1e-12) << vector;
  }

 private:
  SourceFrames frames_;
  M message_;
  std::shared_ptr<TransformBuffer> transforms_ =
      std::make_shared<TransformBuffer>(std::vector<StaticTransform>());
};

const SourceFrames kFrame{"G", "", "", 0};

/// @param pose  of the message's frame in that which is wanted
template <class M>
Transformed<M> in_frame(const Eigen::Isometry3d& pose, const M& message) {
  return {kFrame, pose, message};
}

/// @param body  its pose in the frame of the sensor
template <class M>
Transformed<M> of_body(const Eigen::Isometry3d& body, const M& message) {
  return {{"", "F", "G", 0}, body, message};
}

TEST(TransformMessageTest, PointsAreRotatedAndMoved) {
  geometry_msgs::PointStamped message;
  message.point = made<geometry_msgs::Point>(1, 0, 0);
  in_frame(quarter_turn(), message).expect_near(2, 1, 1, "point");
}

TEST(TransformMessageTest, VectorsAreRotatedOnly) {
  geometry_msgs::Vector3Stamped vector;
  vector.vector = made<geometry_msgs::Vector3>(1, 2, 3);
  in_frame(quarter_turn(), vector).expect_near(-2, 1, 3, "vector");
  sensor_msgs::MagneticField field;
  field.magnetic_field = made<geometry_msgs::Vector3>(1, 2, 3);
  in_frame(quarter_turn(), field).expect_near(-2, 1, 3, "magnetic_field");
  geometry_msgs::AccelStamped accel;
  accel.accel.linear = made<geometry_msgs::Vector3>(1, 0, 0);
  accel.accel.angular = made<geometry_msgs::Vector3>(0, 1, 0);
  const auto transformed = in_frame(quarter_turn(), accel);
  transformed.expect_near(0, 1, 0, "accel.linear");
  transformed.expect_near(-1, 0, 0, "accel.angular");
}

TEST(TransformMessageTest, PosesOfAllTypesAreTransformedAlike) {
  geometry_msgs::PoseStamped pose;
  pose.pose.position = made<geometry_msgs::Point>(1, 0, 0);
  pose.pose.orientation = about_z(0.5);
  geometry_msgs::PoseWithCovarianceStamped uncertain;
  uncertain.pose.pose = pose.pose;
  uncertain.pose.covariance[7] = 4.0;
  nav_msgs::Odometry odometry;
  odometry.pose.pose = pose.pose;
  odometry.twist.twist.linear = made<geometry_msgs::Vector3>(1, 2, 3);
  geometry_msgs::TransformStamped transform;
  transform.transform.translation = made<geometry_msgs::Vector3>(1, 0, 0);
  transform.transform.rotation = pose.pose.orientation;
  geometry_msgs::PoseArray poses;
  poses.poses = {geometry_msgs::Pose(), pose.pose};
  const double yaw = 0.5 + kPi / 2.0;
  const auto expect = [&](const auto& transformed, const std::string& position,
                          const std::string& orientation) {
    transformed.expect_near(2, 1, 1, position);
    EXPECT_NEAR(yaw, transformed(orientation + ".yaw"), 1e-12);
  };
  expect(in_frame(quarter_turn(), pose), "pose.position", "pose.orientation");
  expect(in_frame(quarter_turn(), uncertain), "pose.pose.position", "pose.pose.orientation");
  expect(in_frame(quarter_turn(), odometry), "pose.pose.position", "pose.pose.orientation");
  expect(in_frame(quarter_turn(), transform), "transform.translation", "transform.rotation");
  expect(in_frame(quarter_turn(), poses), "poses.1.position", "poses.1.orientation");
  // The twist is the child's affair.
  in_frame(quarter_turn(), odometry).expect_near(1, 2, 3, "twist.twist.linear");
  EXPECT_EQ(4.0, in_frame(quarter_turn(), uncertain)("pose.covariance.7"));
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
  in_frame(sensor, message).expect_near(0, 0, 0.5, "twist.angular");
  in_frame(sensor, message).expect_near(3, 0, 0, "twist.linear");
  in_frame(sensor, uncertain).expect_near(0, 0, 0.5, "twist.twist.angular");
  in_frame(sensor, uncertain).expect_near(3, 0, 0, "twist.twist.linear");
}

TEST(TransformMessageTest, TheTorqueIsThatAboutTheOtherPoint) {
  // 10 N upward, 2 m ahead, pitch the body up: negative about y.
  geometry_msgs::WrenchStamped message;
  message.wrench.force = made<geometry_msgs::Vector3>(0, 0, 10);
  message.wrench.torque = made<geometry_msgs::Vector3>(1, 0, 0);
  in_frame(quarter_turn(), message).expect_near(0, 0, 10, "wrench.force");
  in_frame(quarter_turn(), message).expect_near(0, 1 - 20, 0, "wrench.torque");
}

TEST(TransformMessageTest, TwistsAndWrenchesGiveTheSamePowerInEveryFrame) {
  geometry_msgs::TwistStamped twist;
  twist.twist.linear = made<geometry_msgs::Vector3>(0.3, -2.0, 1.0);
  twist.twist.angular = made<geometry_msgs::Vector3>(1.5, 0.4, -0.7);
  geometry_msgs::WrenchStamped wrench;
  wrench.wrench.force = made<geometry_msgs::Vector3>(-5.0, 3.0, 2.0);
  wrench.wrench.torque = made<geometry_msgs::Vector3>(0.2, 8.0, -1.0);
  const auto power = [&](const Eigen::Isometry3d& pose) {
    const auto v = in_frame(pose, twist);
    const auto f = in_frame(pose, wrench);
    double sum = 0.0;
    for (const char* axis : {".x", ".y", ".z"}) {
      sum += v(std::string("twist.linear") + axis) * f(std::string("wrench.force") + axis) +
             v(std::string("twist.angular") + axis) * f(std::string("wrench.torque") + axis);
    }
    return sum;
  };
  EXPECT_NEAR(power(Eigen::Isometry3d::Identity()), power(some_transform()), 1e-12);
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
  const auto transformed = in_frame(imu, message);
  EXPECT_NEAR(heading, transformed("orientation.yaw"), 1e-12);
  transformed.expect_near(0, 0, 0.25, "angular_velocity");
  transformed.expect_near(2, 0.5, 9.81, "linear_acceleration");
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
  const auto expect = [&](const auto& body, const std::string& position,
                          const std::string& orientation) {
    body.expect_near(10, 5, 0, position);
    EXPECT_NEAR(kPi / 2.0, body(orientation + ".yaw"), 1e-12);
  };
  expect(of_body(body_in_sensor, pose), "pose.position", "pose.orientation");
  expect(of_body(body_in_sensor, uncertain), "pose.pose.position", "pose.pose.orientation");
  expect(of_body(body_in_sensor, transform), "transform.translation", "transform.rotation");
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
  const auto body = of_body(sensor.inverse(), message);
  const auto expected_pose = of_body(sensor.inverse(), pose);
  const auto expected_twist = in_frame(sensor, twist);
  for (const std::string axis : {".x", ".y", ".z"}) {
    EXPECT_NEAR(expected_pose("pose.position" + axis), body("pose.pose.position" + axis), 1e-12);
    EXPECT_NEAR(expected_twist("twist.linear" + axis), body("twist.twist.linear" + axis), 1e-12);
    EXPECT_NEAR(expected_twist("twist.angular" + axis), body("twist.twist.angular" + axis), 1e-12);
  }
}

TEST(TransformMessageTest, APoseWithoutOrientationHasNoBody) {
  const geometry_msgs::PoseStamped message;  // its quaternion is all zeros
  EXPECT_TRUE(std::isnan(of_body(quarter_turn(), message)("pose.position.x")));
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

template <class M>
std::string fault(const SourceFrames& frames, const std::string& field) {
  TopicSource source = test::source<M>({field});
  source.frames = frames;
  try {
    make_message_source(source);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(FramesTest, ThoseThatATypeHasNoUseForAreRefused) {
  const SourceFrames frame{"map", "", "", 0};
  const SourceFrames body{"", "base_link", "", 0};
  const SourceFrames sensor{"", "base_link", "camera", 0};
  const std::string joint = "position.left";
  EXPECT_NE(std::string::npos,
            fault<sensor_msgs::JointState>(frame, joint)
                .find("file.yaml:3: sensors/s/source/frame: expected none (nothing in "
                      "sensor_msgs/JointState depends on a frame), found 'map'"));
  EXPECT_NE(std::string::npos, fault<geometry_msgs::Point>(frame, "x").find("depends on a frame"));
  EXPECT_NE(
      std::string::npos,
      fault<geometry_msgs::PointStamped>(body, "point.x").find("source/body_frame: expected none"));
  EXPECT_NE(std::string::npos, fault<geometry_msgs::PoseStamped>(body, "pose.position.x")
                                   .find("source/sensor_frame: expected the frame"));
  EXPECT_EQ("no fault", fault<geometry_msgs::PoseStamped>(sensor, "pose.position.x"));
  EXPECT_EQ("no fault", fault<nav_msgs::Odometry>(body, "twist.twist.linear.x"));
  EXPECT_EQ("no fault", fault<sensor_msgs::Imu>(frame, "angular_velocity.x"));
  EXPECT_EQ("no fault", fault<sensor_msgs::JointState>({}, joint));
}

TEST(FramesTest, TheSensorOfABodyIsThatOfTheMessageOrOfTheConfiguration) {
  const auto transforms = std::make_shared<TransformBuffer>(std::vector<StaticTransform>{
      static_transform("base_link", "camera", 1.0), static_transform("base_link", "tag", 2.0)});
  nav_msgs::Odometry message;
  message.header.stamp = to_ros_time(kSecond);
  message.header.frame_id = "odom";
  message.child_frame_id = "camera";
  message.pose.pose.orientation.w = 1.0;
  for (const auto& [sensor, expected] : {std::pair<const char*, double>{"", -1.0}, {"tag", -2.0}}) {
    TopicSource source = test::source<nav_msgs::Odometry>({"pose.pose.position.x"});
    source.frames = {"", "base_link", sensor, 0};
    const test::Read read = test::read(*make_message_source(source, transforms), message);
    ASSERT_EQ(1u, read.values.size());
    EXPECT_NEAR(expected, read.values[0], 1e-12);
  }
}

}  // namespace
}  // namespace sampled_data_observers
