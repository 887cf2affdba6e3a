#include "sampled_data_observers/messages/body_messages.h"

#include <algorithm>

namespace sampled_data_observers {
namespace {

/// Point, Vector3.
template <class M>
void write_vector(const Eigen::Vector3d& vector, M& message) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

void write_quaternion(const Eigen::Quaterniond& quaternion, geometry_msgs::Quaternion& message) {
  message.x = quaternion.x();
  message.y = quaternion.y();
  message.z = quaternion.z();
  message.w = quaternion.w();
}

void write_pose(const BodyEstimate& body, geometry_msgs::PoseWithCovariance& message) {
  write_vector(body.position, message.pose.position);
  write_quaternion(body.orientation, message.pose.orientation);
  std::copy_n(body.pose_covariance.data(), message.covariance.size(), message.covariance.begin());
}

void write_twist(const BodyEstimate& body, geometry_msgs::TwistWithCovariance& message) {
  write_vector(body.linear_velocity, message.twist.linear);
  write_vector(body.angular_velocity, message.twist.angular);
  std::copy_n(body.twist_covariance.data(), message.covariance.size(), message.covariance.begin());
}

}  // namespace

void write(const BodyEstimate& body, nav_msgs::Odometry& message) {
  write_pose(body, message.pose);
  write_twist(body, message.twist);
}

void write(const BodyEstimate& body, geometry_msgs::PoseWithCovarianceStamped& message) {
  write_pose(body, message.pose);
}

void write(const BodyEstimate& body, geometry_msgs::TwistWithCovarianceStamped& message) {
  write_twist(body, message.twist);
}

void write(const Eigen::Isometry3d& transform, geometry_msgs::Transform& message) {
  write_vector(transform.translation(), message.translation);
  write_quaternion(Eigen::Quaterniond(transform.linear()), message.rotation);
}

}  // namespace sampled_data_observers
