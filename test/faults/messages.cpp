#include "faults/messages.h"

#include <cmath>

#include "messages/time_conversion.h"

namespace sampled_data_observers::test {

Measurement measurement(Stamp stamp, const std::vector<double>& values) {
  Measurement message;
  message.header.stamp = to_ros_time(stamp);
  message.values = values;
  return message;
}

Input input(Stamp stamp, const std::vector<double>& values) {
  Input message;
  message.header.stamp = to_ros_time(stamp);
  message.values = values;
  return message;
}

JumpEvent jump_event(Stamp stamp, int mode) {
  JumpEvent message;
  message.header.stamp = to_ros_time(stamp);
  message.mode = mode;
  return message;
}

sensor_msgs::JointState joint_state(Stamp stamp, const std::vector<std::string>& names,
                                    const std::vector<double>& positions) {
  sensor_msgs::JointState message;
  message.header.stamp = to_ros_time(stamp);
  message.name = names;
  message.position = positions;
  return message;
}

sensor_msgs::Imu heading(Stamp stamp, double yaw) {
  sensor_msgs::Imu message;
  message.header.stamp = to_ros_time(stamp);
  message.orientation.z = std::sin(0.5 * yaw);
  message.orientation.w = std::cos(0.5 * yaw);
  return message;
}

geometry_msgs::WrenchStamped contact(Stamp stamp, double force) {
  geometry_msgs::WrenchStamped message;
  message.header.stamp = to_ros_time(stamp);
  message.wrench.force.z = force;
  return message;
}

tf2_msgs::TFMessage turntable(Stamp stamp) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = message.transforms[0];
  transform.header.stamp = to_ros_time(stamp);
  transform.header.frame_id = "map";
  transform.child_frame_id = "turntable";
  transform.transform.translation.x = 10.0;
  transform.transform.rotation.z = 1.0;
  return message;
}

geometry_msgs::PointStamped point_ahead(Stamp stamp, const std::string& frame, double p) {
  geometry_msgs::PointStamped message;
  message.header.stamp = to_ros_time(stamp);
  message.header.frame_id = frame;
  message.point.x = 10.0 - 0.5 - p;
  return message;
}

}  // namespace sampled_data_observers::test
