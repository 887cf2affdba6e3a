// What configurations can take out of messages, by the names of fields.
#include <geometry_msgs/AccelStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/Pose2D.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <sampled_data_observers/StateEstimate.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/Range.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_msgs/Int32.h>

#include <cmath>

#include "messages/source_reading.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::expect_parts;
using test::fault_of;
using test::kReceipt;
using test::kStamp;
using test::Read;
using test::read;
using test::source;

/// Reads the message's fields, one by one and all at once, and compares; the stamp, too.
template <class M>
void expect_fields(M message, const std::vector<std::pair<std::string, double>>& expected) {
  ros::Time* stamp = ros::message_traits::TimeStamp<M>::pointer(message);
  if (stamp != nullptr) stamp->fromNSec(kStamp);
  std::vector<std::string> paths;
  std::vector<double> values;
  for (const auto& [path, value] : expected) {
    paths.push_back(path);
    values.push_back(value);
    EXPECT_EQ(std::vector<double>{value}, read(message, {path}).values) << path;
  }
  const Read all = read(message, paths);
  EXPECT_EQ(values, all.values);
  EXPECT_EQ(stamp != nullptr ? kStamp : kReceipt, all.event.stamp);
  const std::string unknown = fault_of([&] { read(message, {"nothing"}); });
  EXPECT_NE(std::string::npos, unknown.find("'nothing'")) << unknown;
  EXPECT_NE(std::string::npos, unknown.find(expected.front().first)) << unknown;
}

template <class V>
V vector(double x, double y, double z) {
  V result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

geometry_msgs::Pose pose() {
  geometry_msgs::Pose result;
  result.position = vector<geometry_msgs::Point>(1.0, 2.0, 3.0);
  result.orientation.z = 0.6;
  result.orientation.w = 0.8;
  return result;
}

template <class M>
M linear_and_angular() {
  M result;
  result.linear = vector<geometry_msgs::Vector3>(1.0, 2.0, 3.0);
  result.angular = vector<geometry_msgs::Vector3>(4.0, 5.0, 6.0);
  return result;
}

using Expected = std::vector<std::pair<std::string, double>>;

Expected below(const std::string& prefix, const Expected& fields) {
  Expected result;
  for (const auto& [path, value] : fields) result.emplace_back(prefix + path, value);
  return result;
}

const Expected kXyz = {{"x", 1.0}, {"y", 2.0}, {"z", 3.0}};
const Expected kPose = {{"position.x", 1.0},    {"position.y", 2.0},    {"position.z", 3.0},
                        {"orientation.x", 0.0}, {"orientation.y", 0.0}, {"orientation.z", 0.6},
                        {"orientation.w", 0.8}};
const Expected kLinearAndAngular = {{"linear.x", 1.0},  {"linear.y", 2.0},  {"linear.z", 3.0},
                                    {"angular.x", 4.0}, {"angular.y", 5.0}, {"angular.z", 6.0}};

TEST(MessageFieldsTest, PointAndVector) {
  expect_fields(vector<geometry_msgs::Point>(1.0, 2.0, 3.0), kXyz);
  expect_fields(vector<geometry_msgs::Vector3>(1.0, 2.0, 3.0), kXyz);
  geometry_msgs::PointStamped point;
  point.point = vector<geometry_msgs::Point>(1.0, 2.0, 3.0);
  expect_fields(point, below("point.", kXyz));
  geometry_msgs::Vector3Stamped stamped;
  stamped.vector = vector<geometry_msgs::Vector3>(1.0, 2.0, 3.0);
  expect_fields(stamped, below("vector.", kXyz));
}

TEST(MessageFieldsTest, Pose) {
  expect_fields(pose(), kPose);
  geometry_msgs::PoseStamped stamped;
  stamped.pose = pose();
  expect_fields(stamped, below("pose.", kPose));
  geometry_msgs::PoseWithCovariance with_covariance;
  with_covariance.pose = pose();
  expect_fields(with_covariance, below("pose.", kPose));
  geometry_msgs::PoseWithCovarianceStamped both;
  both.pose = with_covariance;
  expect_fields(both, below("pose.pose.", kPose));
}

TEST(MessageFieldsTest, Transform) {
  geometry_msgs::Transform transform;
  transform.translation = vector<geometry_msgs::Vector3>(1.0, 2.0, 3.0);
  transform.rotation.w = 1.0;
  const Expected fields = {{"translation.x", 1.0},
                           {"translation.y", 2.0},
                           {"translation.z", 3.0},
                           {"rotation.w", 1.0},
                           {"rotation.yaw", 0.0}};
  expect_fields(transform, fields);
  geometry_msgs::TransformStamped stamped;
  stamped.transform = transform;
  expect_fields(stamped, below("transform.", fields));
}

TEST(MessageFieldsTest, TwistAndAccel) {
  const auto twist = linear_and_angular<geometry_msgs::Twist>();
  expect_fields(twist, kLinearAndAngular);
  geometry_msgs::TwistStamped stamped;
  stamped.twist = twist;
  expect_fields(stamped, below("twist.", kLinearAndAngular));
  geometry_msgs::TwistWithCovariance with_covariance;
  with_covariance.twist = twist;
  expect_fields(with_covariance, below("twist.", kLinearAndAngular));
  geometry_msgs::TwistWithCovarianceStamped both;
  both.twist = with_covariance;
  expect_fields(both, below("twist.twist.", kLinearAndAngular));
  const auto accel = linear_and_angular<geometry_msgs::Accel>();
  expect_fields(accel, kLinearAndAngular);
  geometry_msgs::AccelStamped stamped_accel;
  stamped_accel.accel = accel;
  expect_fields(stamped_accel, below("accel.", kLinearAndAngular));
}

TEST(MessageFieldsTest, Wrench) {
  geometry_msgs::Wrench wrench;
  wrench.force = vector<geometry_msgs::Vector3>(1.0, 2.0, 3.0);
  wrench.torque = vector<geometry_msgs::Vector3>(4.0, 5.0, 6.0);
  const Expected fields = {{"force.x", 1.0},  {"force.y", 2.0},  {"force.z", 3.0},
                           {"torque.x", 4.0}, {"torque.y", 5.0}, {"torque.z", 6.0}};
  expect_fields(wrench, fields);
  geometry_msgs::WrenchStamped stamped;
  stamped.wrench = wrench;
  expect_fields(stamped, below("wrench.", fields));
}

TEST(MessageFieldsTest, Odometry) {
  nav_msgs::Odometry odometry;
  odometry.pose.pose = pose();
  odometry.twist.twist = linear_and_angular<geometry_msgs::Twist>();
  expect_fields(odometry, below("pose.pose.", kPose));
  expect_fields(odometry, below("twist.twist.", kLinearAndAngular));
}

TEST(MessageFieldsTest, Imu) {
  sensor_msgs::Imu imu;
  imu.orientation = pose().orientation;
  imu.angular_velocity = vector<geometry_msgs::Vector3>(1.0, 2.0, 3.0);
  imu.linear_acceleration = vector<geometry_msgs::Vector3>(4.0, 5.0, 6.0);
  expect_fields(imu, {{"orientation.w", 0.8},
                      {"angular_velocity.x", 1.0},
                      {"angular_velocity.y", 2.0},
                      {"angular_velocity.z", 3.0},
                      {"linear_acceleration.x", 4.0},
                      {"linear_acceleration.y", 5.0},
                      {"linear_acceleration.z", 6.0}});
  imu.orientation_covariance[0] = -1.0;  // it says that it has none
  EXPECT_EQ(Reading::kNoField, read(imu, {"orientation.w"}).reading);
  EXPECT_EQ(-1.0, read(imu, {"orientation_covariance.0"}).values[0]);
  EXPECT_EQ(Reading::kEvent, read(imu, {"angular_velocity.x"}).reading);
}

TEST(MessageFieldsTest, JointStateByNameOfTheJoint) {
  sensor_msgs::JointState joints;
  joints.name = {"right", "left.wheel"};
  joints.position = {1.0, 2.0};
  joints.velocity = {3.0, 4.0};
  joints.effort = {5.0};
  const Read both = read(joints, {"position.left.wheel", "velocity.right", "effort.right"});
  EXPECT_EQ((std::vector<double>{2.0, 3.0, 5.0}), both.values);
  EXPECT_EQ(Reading::kNoField, read(joints, {"position.third"}).reading);
  EXPECT_EQ(Reading::kNoField, read(joints, {"effort.left.wheel"}).reading);
  const std::string unknown = fault_of([&] { read(joints, {"torque.left"}); });
  expect_parts(unknown, {"position.NAME, velocity.NAME, effort.NAME", "'torque.left'"});
  EXPECT_NE("no fault", fault_of([&] { read(joints, {"position."}); }));
}

TEST(MessageFieldsTest, AJointThatMovesInTheListIsFoundAgain) {
  const auto joint = make_message_source(source<sensor_msgs::JointState>({"position.left"}));
  sensor_msgs::JointState joints;
  joints.name = {"left", "right"};
  joints.position = {1.0, 2.0};
  EXPECT_EQ(std::vector<double>{1.0}, read(*joint, joints).values);
  joints.name = {"right", "left"};
  EXPECT_EQ(std::vector<double>{2.0}, read(*joint, joints).values);
}

TEST(MessageFieldsTest, Range) {
  sensor_msgs::Range range;
  range.range = 2.0f;
  range.min_range = 0.5f;
  range.max_range = 4.0f;
  expect_fields(range, {{"range", 2.0}});
  range.range = 4.5f;
  EXPECT_EQ(Reading::kNoField, read(range, {"range"}).reading);
  range.min_range = range.max_range = 0.0f;  // it does not say what it can measure
  EXPECT_EQ(Reading::kEvent, read(range, {"range"}).reading);
}

TEST(MessageFieldsTest, MagneticFieldAndFluidPressure) {
  sensor_msgs::MagneticField field;
  field.magnetic_field = vector<geometry_msgs::Vector3>(1.0, 2.0, 3.0);
  expect_fields(field, below("magnetic_field.", kXyz));
  sensor_msgs::FluidPressure pressure;
  pressure.fluid_pressure = 1e5;
  expect_fields(pressure, {{"fluid_pressure", 1e5}});
}

TEST(MessageFieldsTest, Numbers) {
  std_msgs::Float64 number;
  number.data = 7.0;
  expect_fields(number, {{"data", 7.0}});
  std_msgs::Float64MultiArray array;
  array.data = {1.0, 2.0, 3.0};
  EXPECT_EQ((std::vector<double>{3.0, 1.0}), read(array, {"data.2", "data.0"}).values);
  EXPECT_EQ(Reading::kNoField, read(array, {"data.3"}).reading);
  for (const char* path : {"data", "data.", "data.x", "data.-1", "data.1x"}) {
    expect_parts(fault_of([&] { read(array, {path}); }), {"data.INDEX"});
  }
}

TEST(MessageFieldsTest, TypesThatAreNeverStamped) {
  geometry_msgs::Pose2D pose;
  pose.x = 1.0;
  pose.theta = 0.5;
  expect_fields(pose, {{"x", 1.0}, {"theta", 0.5}});
  std_msgs::Float32 number;
  number.data = 0.1f;
  expect_fields(number, {{"data", static_cast<double>(0.1f)}});
  std_msgs::Int32 whole;
  whole.data = -7;
  expect_fields(whole, {{"data", -7.0}});
  std_msgs::Bool truth;
  truth.data = 1;
  expect_fields(truth, {{"data", 1.0}});
}

TEST(MessageFieldsTest, LaserScanByIndex) {
  sensor_msgs::LaserScan scan;
  scan.range_max = 30.0f;
  scan.ranges = {1.0f, 2.0f};
  scan.intensities = {5.0f};
  expect_fields(
      scan, {{"range_max", 30.0}, {"ranges.0", 1.0}, {"ranges.1", 2.0}, {"intensities.0", 5.0}});
  EXPECT_EQ(Reading::kNoField, read(scan, {"ranges.2"}).reading);
  EXPECT_EQ(Reading::kNoField, read(scan, {"intensities.1"}).reading);
}

TEST(MessageFieldsTest, NavSatFixWithAFix) {
  sensor_msgs::NavSatFix fix;
  fix.latitude = 47.5;
  fix.position_covariance[4] = 2.0;
  expect_fields(fix, {{"latitude", 47.5}, {"position_covariance.4", 2.0}});
  fix.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
  EXPECT_EQ(Reading::kNoField, read(fix, {"latitude"}).reading);
}

TEST(MessageFieldsTest, StatesOfAnEstimateByTheirNames) {
  StateEstimate estimate;
  estimate.names = {"p", "v"};
  estimate.state = {1.0, 2.0};
  EXPECT_EQ((std::vector<double>{2.0, 1.0}), read(estimate, {"state.v", "state.p"}).values);
  EXPECT_EQ(Reading::kNoField, read(estimate, {"state.w"}).reading);
}

TEST(OrientationTest, AnglesAreThoseOfTheRotation) {
  // About z by 0.3, after y by -0.7, after x by 2.5.
  const double roll = 2.5, pitch = -0.7, yaw = 0.3;
  const double cr = std::cos(roll / 2), sr = std::sin(roll / 2), cp = std::cos(pitch / 2),
               sp = std::sin(pitch / 2), cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
  geometry_msgs::Pose message;
  message.orientation.w = cr * cp * cy + sr * sp * sy;
  message.orientation.x = sr * cp * cy - cr * sp * sy;
  message.orientation.y = cr * sp * cy + sr * cp * sy;
  message.orientation.z = cr * cp * sy - sr * sp * cy;
  const std::vector<std::string> fields = {"orientation.roll", "orientation.pitch",
                                           "orientation.yaw"};
  const Read angles = read(message, fields);
  EXPECT_NEAR(roll, angles.values[0], 1e-15);
  EXPECT_NEAR(pitch, angles.values[1], 1e-15);
  EXPECT_NEAR(yaw, angles.values[2], 1e-15);

  geometry_msgs::Pose longer = message;  // rounded to float somewhere, say
  for (double* q : {&longer.orientation.w, &longer.orientation.x, &longer.orientation.y,
                    &longer.orientation.z}) {
    *q *= 1.005;
  }
  EXPECT_NEAR(pitch, read(longer, fields).values[1], 1e-14);
}

TEST(OrientationTest, StraightUpHasAPitchThatIsFinite) {
  geometry_msgs::Pose message;
  message.orientation.w = message.orientation.y = std::sqrt(0.5) * (1.0 + 1e-12);
  EXPECT_NEAR(std::acos(0.0), read(message, {"orientation.pitch"}).values[0], 1e-6);
}

TEST(OrientationTest, WhatIsNoRotationHasNoAngles) {
  geometry_msgs::Pose message;
  const std::vector<std::string> yaw = {"orientation.yaw"};
  EXPECT_TRUE(std::isnan(read(message, yaw).values[0]));  // all zero: never filled in
  message.orientation.w = 1.02;
  EXPECT_TRUE(std::isnan(read(message, yaw).values[0]));
  message.orientation.w = std::nan("");
  EXPECT_TRUE(std::isnan(read(message, yaw).values[0]));
}

}  // namespace
}  // namespace sampled_data_observers
