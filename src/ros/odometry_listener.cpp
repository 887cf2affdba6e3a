#include "sampled_data_observers/ros/odometry_listener.h"

#include <utility>

#include "messages/time_conversion.h"

namespace sampled_data_observers {

OdometryListener::OdometryListener(std::string odom_frame, std::string base_frame)
    : odom_frame_(std::move(odom_frame)), base_frame_(std::move(base_frame)) {}

std::optional<Eigen::Isometry3d> OdometryListener::find(Stamp stamp) const {
  const tf2::BufferCore& buffer = buffer_;
  const ros::Time time = to_ros_time(stamp);
  if (!buffer.canTransform(odom_frame_, base_frame_, time)) return std::nullopt;
  try {
    const geometry_msgs::Transform found =
        buffer.lookupTransform(odom_frame_, base_frame_, time).transform;
    return Eigen::Translation3d(found.translation.x, found.translation.y, found.translation.z) *
           Eigen::Quaterniond(found.rotation.w, found.rotation.x, found.rotation.y,
                              found.rotation.z);
  } catch (const tf2::TransformException&) {
    return std::nullopt;  // it was forgotten meanwhile
  }
}

}  // namespace sampled_data_observers
