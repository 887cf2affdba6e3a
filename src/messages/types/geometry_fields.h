#pragma once

#include <geometry_msgs/Accel.h>
#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistWithCovariance.h>
#include <geometry_msgs/Vector3.h>
#include <geometry_msgs/Wrench.h>

#include "messages/message_fields.h"

namespace sampled_data_observers {

void add_fields(MessageFields<geometry_msgs::Accel>& fields);
void add_fields(MessageFields<geometry_msgs::Point>& fields);
void add_fields(MessageFields<geometry_msgs::Pose>& fields);
void add_fields(MessageFields<geometry_msgs::PoseWithCovariance>& fields);
/// The components as they are, and the angles roll, pitch and yaw [rad] of the rotation about the
/// fixed axes x, y, z in this order. These are NaN, which is rejected, for a quaternion whose
/// norm is not within 1 % of 1.
void add_fields(MessageFields<geometry_msgs::Quaternion>& fields);
void add_fields(MessageFields<geometry_msgs::Transform>& fields);
void add_fields(MessageFields<geometry_msgs::Twist>& fields);
void add_fields(MessageFields<geometry_msgs::TwistWithCovariance>& fields);
void add_fields(MessageFields<geometry_msgs::Vector3>& fields);
void add_fields(MessageFields<geometry_msgs::Wrench>& fields);

}  // namespace sampled_data_observers
