#pragma once

#include <geometry_msgs/AccelStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MagneticField.h>

#include <Eigen/Geometry>

namespace sampled_data_observers {

/// @name Into another frame
/// Rewrites what a message says in its own frame F, header.frame_id, for a frame G.
/// @param transform  the pose of F in G. Covariances and names of frames stay.
/// @{

/// p_G = R p_F + t.
void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::PointStamped& message);
/// v_G = R v_F.
void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::Vector3Stamped& message);
void to_frame(const Eigen::Isometry3d& transform, sensor_msgs::MagneticField& message);
/// The position is a point; q_G = q q_F.
void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::PoseStamped& message);
void to_frame(const Eigen::Isometry3d& transform,
              geometry_msgs::PoseWithCovarianceStamped& message);
void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::TransformStamped& message);
/// The pose only: the twist is given in the child's frame.
void to_frame(const Eigen::Isometry3d& transform, nav_msgs::Odometry& message);

/// The velocity of F's origin becomes that of G's origin, both on one rigid body:
/// ω_G = R ω_F, v_G = R v_F + t × ω_G.
void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::TwistStamped& message);
void to_frame(const Eigen::Isometry3d& transform,
              geometry_msgs::TwistWithCovarianceStamped& message);
/// The torque about F's origin becomes that about G's: f_G = R f_F, τ_G = R τ_F + t × f_G.
void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::WrenchStamped& message);

/// Rotates only. The acceleration of another point of the body would take the angular velocity, and
/// the angular acceleration, which these messages' senders seldom know.
void to_frame(const Eigen::Isometry3d& transform, geometry_msgs::AccelStamped& message);
/// F is the sensor's own frame, G one on the same body: angular velocity and acceleration are
/// rotated, and the orientation of F in the world becomes that of G, q_WG = q_WF q⁻¹. The
/// acceleration remains that of F's origin, for the reason above.
void to_frame(const Eigen::Isometry3d& transform, sensor_msgs::Imu& message);

/// @}

/// @name From a sensor to the body that bears it
/// @param body  the pose of the body in the frame of the sensor whose pose the message gives
/// @{

/// T_GB = T_GS T_SB. Not finite where the message's orientation is not a rotation.
void to_body(const Eigen::Isometry3d& body, geometry_msgs::PoseStamped& message);
void to_body(const Eigen::Isometry3d& body, geometry_msgs::PoseWithCovarianceStamped& message);
void to_body(const Eigen::Isometry3d& body, geometry_msgs::TransformStamped& message);
/// The pose likewise, and the twist from the sensor's frame into the body's.
void to_body(const Eigen::Isometry3d& body, nav_msgs::Odometry& message);

/// @}

}  // namespace sampled_data_observers
