#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sampled_data_observers/Input.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <limits>
#include <string>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers::test {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Measurement measurement(Stamp stamp, const std::vector<double>& values);
Input input(Stamp stamp, const std::vector<double>& values);
JumpEvent jump_event(Stamp stamp, int mode = 0);
sensor_msgs::JointState joint_state(Stamp stamp, const std::vector<std::string>& names,
                                    const std::vector<double>& positions);
/// Level, with this yaw [rad].
sensor_msgs::Imu heading(Stamp stamp, double yaw);
/// Of a force along z [N].
geometry_msgs::WrenchStamped contact(Stamp stamp, double force);

/// map -> turntable: half a turn about z, at x = 10.
tf2_msgs::TFMessage turntable(Stamp stamp);
/// The point at x = p on the x axis of the map, in the frame of the lens on the turntable.
geometry_msgs::PointStamped point_ahead(Stamp stamp, const std::string& frame, double p);

}  // namespace sampled_data_observers::test
