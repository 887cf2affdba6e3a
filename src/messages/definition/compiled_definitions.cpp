#include <geometry_msgs/AccelStamped.h>
#include <geometry_msgs/AccelWithCovarianceStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/Pose2D.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/message_traits.h>
#include <sampled_data_observers/StateEstimate.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/Range.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_msgs/Header.h>
#include <std_msgs/Int32.h>
#include <std_msgs/Time.h>
#include <tf2_msgs/TFMessage.h>

#include <map>

#include "messages/definition/installed_definitions.h"

namespace sampled_data_observers {
namespace {

using Definitions = std::map<std::string, const char*>;

template <class... Messages>
Definitions definitions_of() {
  return {{ros::message_traits::DataType<Messages>::value(),
           ros::message_traits::Definition<Messages>::value()}...};
}

const Definitions& compiled_definitions() {
  static const Definitions kDefinitions = definitions_of<
      StateEstimate, geometry_msgs::Accel, geometry_msgs::AccelStamped,
      geometry_msgs::AccelWithCovarianceStamped, geometry_msgs::Point, geometry_msgs::PointStamped,
      geometry_msgs::Pose, geometry_msgs::Pose2D, geometry_msgs::PoseStamped,
      geometry_msgs::PoseWithCovariance, geometry_msgs::PoseWithCovarianceStamped,
      geometry_msgs::Quaternion, geometry_msgs::QuaternionStamped, geometry_msgs::Transform,
      geometry_msgs::TransformStamped, geometry_msgs::Twist, geometry_msgs::TwistStamped,
      geometry_msgs::TwistWithCovariance, geometry_msgs::TwistWithCovarianceStamped,
      geometry_msgs::Vector3, geometry_msgs::Vector3Stamped, geometry_msgs::Wrench,
      geometry_msgs::WrenchStamped, nav_msgs::Odometry, sensor_msgs::FluidPressure,
      sensor_msgs::Imu, sensor_msgs::JointState, sensor_msgs::LaserScan, sensor_msgs::MagneticField,
      sensor_msgs::NavSatFix, sensor_msgs::Range, std_msgs::Bool, std_msgs::Float32,
      std_msgs::Float64, std_msgs::Float64MultiArray, std_msgs::Header, std_msgs::Int32,
      std_msgs::Time, tf2_msgs::TFMessage>();
  return kDefinitions;
}

}  // namespace

const char* compiled_definition(const std::string& type) {
  const auto found = compiled_definitions().find(type);
  return found == compiled_definitions().end() ? nullptr : found->second;
}

std::vector<std::string> compiled_types(const std::string& package) {
  std::vector<std::string> types;
  const std::string prefix = package + "/";
  for (const auto& [type, definition] : compiled_definitions()) {
    if (type.compare(0, prefix.size(), prefix) == 0) types.push_back(type.substr(prefix.size()));
  }
  return types;
}

}  // namespace sampled_data_observers
