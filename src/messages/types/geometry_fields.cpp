#include "messages/types/geometry_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sampled_data_observers {
namespace {

using geometry_msgs::Quaternion;

double roll(const Quaternion& q) {
  return std::atan2(2.0 * (q.w * q.x + q.y * q.z), q.w * q.w - q.x * q.x - q.y * q.y + q.z * q.z);
}

double pitch(const Quaternion& q) {
  const double squared_norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return std::asin(std::clamp(2.0 * (q.w * q.y - q.z * q.x) / squared_norm, -1.0, 1.0));
}

double yaw(const Quaternion& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
}

/// An angle of rotations, and NaN for what is none.
FieldGetter<Quaternion> of_rotation(double (*angle)(const Quaternion&)) {
  return [angle](const Quaternion& q) {
    constexpr double kTolerance = 0.01;
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    const bool is_rotation = std::abs(norm - 1.0) <= kTolerance;
    return is_rotation ? angle(q) : std::numeric_limits<double>::quiet_NaN();
  };
}

template <class M>
void add_xyz(MessageFields<M>& fields) {
  fields.value("x", &M::x).value("y", &M::y).value("z", &M::z);
}

template <class M>
void add_linear_and_angular(MessageFields<M>& fields) {
  fields.nested("linear", &M::linear).nested("angular", &M::angular);
}

}  // namespace

void add_fields(MessageFields<geometry_msgs::Point>& fields) { add_xyz(fields); }

void add_fields(MessageFields<geometry_msgs::Vector3>& fields) { add_xyz(fields); }

void add_fields(MessageFields<Quaternion>& fields) {
  add_xyz(fields);
  fields.value("w", &Quaternion::w)
      .computed("roll", of_rotation(roll))
      .computed("pitch", of_rotation(pitch))
      .computed("yaw", of_rotation(yaw));
}

void add_fields(MessageFields<geometry_msgs::Pose>& fields) {
  using M = geometry_msgs::Pose;
  fields.nested("position", &M::position).nested("orientation", &M::orientation);
}

void add_fields(MessageFields<geometry_msgs::PoseWithCovariance>& fields) {
  fields.nested("pose", &geometry_msgs::PoseWithCovariance::pose);
}

void add_fields(MessageFields<geometry_msgs::Transform>& fields) {
  using M = geometry_msgs::Transform;
  fields.nested("translation", &M::translation).nested("rotation", &M::rotation);
}

void add_fields(MessageFields<geometry_msgs::Twist>& fields) { add_linear_and_angular(fields); }

void add_fields(MessageFields<geometry_msgs::TwistWithCovariance>& fields) {
  fields.nested("twist", &geometry_msgs::TwistWithCovariance::twist);
}

void add_fields(MessageFields<geometry_msgs::Accel>& fields) { add_linear_and_angular(fields); }

void add_fields(MessageFields<geometry_msgs::Wrench>& fields) {
  using M = geometry_msgs::Wrench;
  fields.nested("force", &M::force).nested("torque", &M::torque);
}

}  // namespace sampled_data_observers
