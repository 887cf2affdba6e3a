// Standard messages that are well formed, but say nothing, or nonsense.
#include <limits>

#include "faults/fault.h"
#include "faults/messages.h"

namespace sampled_data_observers::test {
namespace {

/// For one second, joint states of these names and positions.
std::function<void(FaultBench&)> joints(const std::vector<std::string>& names,
                                        const std::vector<double>& positions) {
  return [names, positions](FaultBench& bench) {
    bench.go_on(1.0, [&](Stamp stamp) {
      bench.publish("joint_states", joint_state(stamp, names, positions));
    });
  };
}

/// For one second, IMU messages that something is done to.
std::function<void(FaultBench&)> imus(const std::function<void(sensor_msgs::Imu&)>& spoil) {
  return [spoil](FaultBench& bench) {
    bench.go_on(1.0, [&](Stamp stamp) {
      sensor_msgs::Imu message = heading(stamp, bench.truth(stamp)[0]);
      spoil(message);
      bench.publish("imu", message);
    });
  };
}

}  // namespace

std::vector<Fault> message_faults() {
  return {
      {"JointIsMissing",
       "joint",
       "1 s of joint states without the joint",
       joints({"caster"}, {0.5}),
       {{EventStatus::NO_FIELD, 10}}},
      {"JointStatesAreEmpty",
       "joint",
       "1 s of joint states without any joint",
       joints({}, {}),
       {{EventStatus::NO_FIELD, 10}}},
      {"JointHasNoPosition",
       "joint",
       "1 s of joint states with more names than positions",
       joints({"caster", "wheel"}, {0.5}),
       {{EventStatus::NO_FIELD, 10}}},
      {"JointIsNotANumber",
       "joint",
       "1 s of joint states with a position that is NaN",
       joints({"wheel"}, {kNaN}),
       {{EventStatus::NOT_FINITE, 10}}},
      {"OrientationIsNotMeasured",
       "imu",
       "1 s of an IMU whose orientation covariance begins with "
       "-1: it has none",
       imus([](sensor_msgs::Imu& imu) { imu.orientation_covariance[0] = -1.0; }),
       {{EventStatus::NO_FIELD, 10}}},
      {"OrientationIsNotANumber",
       "imu",
       "1 s of an orientation of NaN",
       imus([](sensor_msgs::Imu& imu) { imu.orientation.z = kNaN; }),
       {{EventStatus::NOT_FINITE, 10}}},
      {"OrientationIsZero",
       "imu",
       "1 s of a quaternion of four zeros",
       imus([](sensor_msgs::Imu& imu) { imu.orientation = geometry_msgs::Quaternion(); }),
       {{EventStatus::NOT_FINITE, 10}}},
      {"OrientationIsNoRotation",
       "imu",
       "1 s of a quaternion of norm 2",
       imus([](sensor_msgs::Imu& imu) {
         imu.orientation.z *= 2.0;
         imu.orientation.w *= 2.0;
       }),
       {{EventStatus::NOT_FINITE, 10}}},
      {"NoCovariance",
       "filtered",
       "1 s of an IMU that states no covariance, where the filter takes it from the message",
       imus([](sensor_msgs::Imu&) {}),
       {{EventStatus::NO_COVARIANCE, 10}}},
      {"OrientationHasOtherSign",
       "imu",
       "1 s of the quaternion -q, which is the same rotation",
       imus([](sensor_msgs::Imu& imu) {
         imu.orientation.z *= -1.0;
         imu.orientation.w *= -1.0;
       }),
       {}},
  };
}

}  // namespace sampled_data_observers::test
