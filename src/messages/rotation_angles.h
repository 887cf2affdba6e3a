#pragma once

namespace sampled_data_observers {

/// A quaternion as a message has it.
struct RotationQuaternion {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 0.0;
};

/// @name Angles of a rotation
/// About the fixed axes x, y, z in this order [rad]; NaN for a quaternion whose norm is not within
/// 1 % of 1.
/// @{
double roll_of(const RotationQuaternion& q);
double pitch_of(const RotationQuaternion& q);
double yaw_of(const RotationQuaternion& q);
/// @}

/// The rotation of these angles.
RotationQuaternion rotation_of(double roll, double pitch, double yaw);

}  // namespace sampled_data_observers
