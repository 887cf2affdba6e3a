#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/Range.h>

#include "messages/types/geometry_fields.h"
#include "messages/types/typed_source.h"

namespace sampled_data_observers {
namespace {

/// Finds a joint's entry in each message anew: publishers may change their order, or leave some
/// out.
void add_joints(MessageFields<sensor_msgs::JointState>& fields, const std::string& name,
                std::vector<double> sensor_msgs::JointState::*entries) {
  fields.keyed(name + ".", "JOINT", [entries](const std::string& joint) {
    return [entries, joint](const sensor_msgs::JointState& message) -> std::optional<double> {
      const auto found = std::find(message.name.begin(), message.name.end(), joint);
      const auto index = static_cast<std::size_t>(found - message.name.begin());
      const std::vector<double>& values = message.*entries;
      return index < values.size() ? std::optional<double>(values[index]) : std::nullopt;
    };
  });
}

}  // namespace

void add_fields(MessageFields<sensor_msgs::FluidPressure>& fields) {
  fields.value("fluid_pressure", &sensor_msgs::FluidPressure::fluid_pressure);
}

/// The first entry of a covariance is -1 where the IMU does not measure the quantity.
void add_fields(MessageFields<sensor_msgs::Imu>& fields) {
  using Imu = sensor_msgs::Imu;
  fields
      .nested("orientation", &Imu::orientation,
              [](const Imu& imu) { return imu.orientation_covariance[0] != -1.0; })
      .nested("angular_velocity", &Imu::angular_velocity,
              [](const Imu& imu) { return imu.angular_velocity_covariance[0] != -1.0; })
      .nested("linear_acceleration", &Imu::linear_acceleration,
              [](const Imu& imu) { return imu.linear_acceleration_covariance[0] != -1.0; });
}

void add_fields(MessageFields<sensor_msgs::JointState>& fields) {
  add_joints(fields, "position", &sensor_msgs::JointState::position);
  add_joints(fields, "velocity", &sensor_msgs::JointState::velocity);
  add_joints(fields, "effort", &sensor_msgs::JointState::effort);
}

void add_fields(MessageFields<sensor_msgs::MagneticField>& fields) {
  fields.nested("magnetic_field", &sensor_msgs::MagneticField::magnetic_field);
}

/// A range outside of what the sensor says that it can measure is none.
void add_fields(MessageFields<sensor_msgs::Range>& fields) {
  fields.computed("range", [](const sensor_msgs::Range& message) {
    const bool is_limited = message.min_range < message.max_range;
    const bool is_within = message.min_range <= message.range && message.range <= message.max_range;
    return !is_limited || is_within ? std::optional<double>(message.range) : std::nullopt;
  });
}

void add_sensor_types(MessageTypes& types) {
  add_types<sensor_msgs::FluidPressure, sensor_msgs::Imu, sensor_msgs::JointState,
            sensor_msgs::MagneticField, sensor_msgs::Range>(types);
}

}  // namespace sampled_data_observers
