#include "messages/rotation_angles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sampled_data_observers {
namespace {

bool is_rotation(const RotationQuaternion& q) {
  constexpr double kTolerance = 0.01;
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return std::abs(norm - 1.0) <= kTolerance;
}

constexpr double kNoAngle = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double roll_of(const RotationQuaternion& q) {
  if (!is_rotation(q)) return kNoAngle;
  return std::atan2(2.0 * (q.w * q.x + q.y * q.z), q.w * q.w - q.x * q.x - q.y * q.y + q.z * q.z);
}

double pitch_of(const RotationQuaternion& q) {
  if (!is_rotation(q)) return kNoAngle;
  const double squared_norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return std::asin(std::clamp(2.0 * (q.w * q.y - q.z * q.x) / squared_norm, -1.0, 1.0));
}

double yaw_of(const RotationQuaternion& q) {
  if (!is_rotation(q)) return kNoAngle;
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
}

RotationQuaternion rotation_of(double roll, double pitch, double yaw) {
  const double cr = std::cos(roll / 2.0);
  const double sr = std::sin(roll / 2.0);
  const double cp = std::cos(pitch / 2.0);
  const double sp = std::sin(pitch / 2.0);
  const double cy = std::cos(yaw / 2.0);
  const double sy = std::sin(yaw / 2.0);
  return {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
          cr * cp * cy + sr * sp * sy};
}

}  // namespace sampled_data_observers
