#pragma once

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Listens to tf, on a thread of its own, for the transform between two frames.
class OdometryListener {
 public:
  /// Listens from now on.
  /// @param odom_frame  the parent
  /// @param base_frame  that of the body
  OdometryListener(std::string odom_frame, std::string base_frame);

  /// The pose of the base frame in the odometry's frame at a stamp, interpolated; nothing where it
  /// is not known (yet). It does not wait.
  std::optional<Eigen::Isometry3d> find(Stamp stamp) const;

 private:
  const std::string odom_frame_;
  const std::string base_frame_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_{buffer_};
};

}  // namespace sampled_data_observers
