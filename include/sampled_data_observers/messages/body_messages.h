#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>

#include "sampled_data_observers/runtime/body_estimate.h"

namespace sampled_data_observers {

/// Writes a body's pose and velocity, but neither header nor frames. Allocates nothing.
void write(const BodyEstimate& body, nav_msgs::Odometry& message);
/// The same of its pose alone. Allocates nothing.
void write(const BodyEstimate& body, geometry_msgs::PoseWithCovarianceStamped& message);
/// The same of its velocity alone. Allocates nothing.
void write(const BodyEstimate& body, geometry_msgs::TwistWithCovarianceStamped& message);
/// Writes translation [m] and rotation. Allocates nothing.
void write(const Eigen::Isometry3d& transform, geometry_msgs::Transform& message);

}  // namespace sampled_data_observers
