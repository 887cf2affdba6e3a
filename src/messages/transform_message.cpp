#include "messages/transform_message.h"

namespace sampled_data_observers {
namespace {

template <class V>
Eigen::Vector3d as_vector(const V& v) {
  return {v.x, v.y, v.z};
}

template <class V>
void assign(const Eigen::Vector3d& from, V& to) {
  to.x = from.x();
  to.y = from.y();
  to.z = from.z();
}

Eigen::Quaterniond as_quaternion(const geometry_msgs::Quaternion& q) {
  return {q.w, q.x, q.y, q.z};
}

void assign(const Eigen::Quaterniond& from, geometry_msgs::Quaternion& to) {
  to.w = from.w();
  to.x = from.x();
  to.y = from.y();
  to.z = from.z();
}

template <class V>
void rotate(const Eigen::Isometry3d& transform, V& vector) {
  assign(transform.linear() * as_vector(vector), vector);
}

template <class Position>
void transform_pose(const Eigen::Isometry3d& transform, Position& position,
                    geometry_msgs::Quaternion& orientation) {
  assign(transform * as_vector(position), position);
  assign(Eigen::Quaterniond(transform.linear()) * as_quaternion(orientation), orientation);
}

template <class Position>
void move_pose(const Eigen::Isometry3d& body, Position& position,
               geometry_msgs::Quaternion& orientation) {
  Eigen::Quaterniond q = as_quaternion(orientation);
  q.coeffs() /= q.norm();  // normalize() would take zero for a rotation
  assign(as_vector(position) + q * body.translation(), position);
  assign(q * Eigen::Quaterniond(body.linear()), orientation);
}

/// Of twists (free: ω, bound: v) and wrenches (free: f, bound: τ) alike.
void transform_screw(const Eigen::Isometry3d& transform, geometry_msgs::Vector3& free,
                     geometry_msgs::Vector3& bound) {
  rotate(transform, free);
  assign(transform.linear() * as_vector(bound) + transform.translation().cross(as_vector(free)),
         bound);
}

}  // namespace

void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::PointStamped& message) {
  assign(transform * as_vector(message.point), message.point);
}

void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::Vector3Stamped& message) {
  rotate(transform, message.vector);
}

void to_frame(const Eigen::Isometry3d& transform, sensor_msgs::MagneticField& message) {
  rotate(transform, message.magnetic_field);
}

void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::PoseStamped& message) {
  transform_pose(transform, message.pose.position, message.pose.orientation);
}

void to_frame(const Eigen::Isometry3d& transform,
              geometry_msgs::PoseWithCovarianceStamped& message) {
  transform_pose(transform, message.pose.pose.position, message.pose.pose.orientation);
}

void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::TransformStamped& message) {
  transform_pose(transform, message.transform.translation, message.transform.rotation);
}

void to_frame(const Eigen::Isometry3d& transform, nav_msgs::Odometry& message) {
  transform_pose(transform, message.pose.pose.position, message.pose.pose.orientation);
}

void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::TwistStamped& message) {
  transform_screw(transform, message.twist.angular, message.twist.linear);
}

void to_frame(const Eigen::Isometry3d& transform,
              geometry_msgs::TwistWithCovarianceStamped& message) {
  transform_screw(transform, message.twist.twist.angular, message.twist.twist.linear);
}

void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::WrenchStamped& message) {
  transform_screw(transform, message.wrench.force, message.wrench.torque);
}

void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::AccelStamped& message) {
  rotate(transform, message.accel.linear);
  rotate(transform, message.accel.angular);
}

void to_frame(const Eigen::Isometry3d& transform, sensor_msgs::Imu& message) {
  rotate(transform, message.angular_velocity);
  rotate(transform, message.linear_acceleration);
  const Eigen::Quaterniond inverse = Eigen::Quaterniond(transform.linear()).conjugate();
  assign(as_quaternion(message.orientation) * inverse, message.orientation);
}

void to_body(const Eigen::Isometry3d& body, geometry_msgs::PoseStamped& message) {
  move_pose(body, message.pose.position, message.pose.orientation);
}

void to_body(const Eigen::Isometry3d& body, geometry_msgs::PoseWithCovarianceStamped& message) {
  move_pose(body, message.pose.pose.position, message.pose.pose.orientation);
}

void to_body(const Eigen::Isometry3d& body, geometry_msgs::TransformStamped& message) {
  move_pose(body, message.transform.translation, message.transform.rotation);
}

void to_body(const Eigen::Isometry3d& body, nav_msgs::Odometry& message) {
  move_pose(body, message.pose.pose.position, message.pose.pose.orientation);
  transform_screw(body.inverse(), message.twist.twist.angular, message.twist.twist.linear);
}

}  // namespace sampled_data_observers
