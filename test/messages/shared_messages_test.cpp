// Simulated messages that several sensors and inputs read: as in the robot's configuration, one
// message has what all of them are to find in it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "messages/simulated_messages.h"
#include "messages/source_reading.h"
#include "simulation/simulation_support.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

const char kHuskyPose[] = "/config/husky_pose.yaml";
const char kDrive[] = R"yaml(
scenario:
  duration: 0.1
  initial_state: {x: 0, y: 0, z: 0, qw: 1, qx: 0, qy: 0, qz: 0}
  input: {rate: 50, formulas: {v: 1 + t, wx: 0, wy: 0, wz: 0.5}}
  sensors: {imu: {schedule: {period: 0.02}, latency: [0.005, 0.005]}}
)yaml";

/// Of a simulation, by topic: the values that each reading finds in each message.
class SharedMessages {
 public:
  explicit SharedMessages(const Scenario& scenario) : simulator_(scenario) {
    const SimulatedMessages messages(simulator_.channels(), scenario.navsat);
    const auto frames = std::make_shared<TransformBuffer>(std::vector<StaticTransform>());
    while (const auto simulated = simulator_.next()) {
      const SimulatedChannel& channel = simulator_.channels()[simulated->channel];
      std::vector<std::vector<double>> found;
      for (const SimulatedReading& reading : channel.readings) {
        const auto reader = make_message_source(reading.source, frames);
        messages.visit(*simulated, [&](const auto& message) {
          const test::Read read = test::read(*reader, message);
          EXPECT_EQ(Reading::kEvent, read.reading) << reading.source.path;
          EXPECT_EQ(simulated->stamp, read.event.stamp) << reading.source.path;
          found.push_back(read.values);
        });
      }
      arrivals_[channel.topic].push_back(simulated->arrival - test::kFirst);
      found_[channel.topic].push_back(found);
    }
  }

  const std::vector<std::vector<std::vector<double>>>& on(const std::string& topic) {
    return found_[topic];
  }
  const std::vector<Stamp>& arrivals_on(const std::string& topic) { return arrivals_[topic]; }

 private:
  Simulator simulator_;
  std::map<std::string, std::vector<std::vector<std::vector<double>>>> found_;
  std::map<std::string, std::vector<Stamp>> arrivals_;
};

TEST(SharedMessagesTest, OneImuHasOrientationAndRates) {
  const ConfigNode robot = read_yaml_file(std::string(SDO_SOURCE_DIR) + kHuskyPose);
  SharedMessages messages(
      read_scenario(merge({robot, read_yaml_text(kDrive, "drive.yaml")}), no_plant_plugins));
  const auto& imu = messages.on("/imu/data");
  ASSERT_EQ(6u, imu.size());
  for (std::size_t i = 0; i < imu.size(); ++i) {
    ASSERT_EQ(2u, imu[i].size());
    ASSERT_EQ(3u, imu[i][0].size());
    EXPECT_NEAR(0.5 * 0.02 * static_cast<double>(i), imu[i][0][2], 1e-9);  // the sensor's yaw
    EXPECT_EQ((std::vector<double>{0.0, 0.0, 0.5}), imu[i][1]);            // the input's rates
    EXPECT_EQ(static_cast<Stamp>(i) * 20'000'000 + 5'000'000, messages.arrivals_on("/imu/data")[i]);
  }
  const auto& wheels = messages.on("/husky_velocity_controller/odom");
  ASSERT_EQ(6u, wheels.size());
  EXPECT_EQ((std::vector<std::vector<double>>{{1.02}}), wheels[1]);
}

/// Two sensors and two inputs, in messages of one type on one topic; and two at jumps.
const char kOdometry[] = R"yaml(
plant:
  states: [x, v]
  inputs: [u, w]
  A: [[0, 1], [0, 0]]
  B: [[0, 0], [1, 1]]
  jump_map: {A_d: [[1, 0], [0, -1]]}
sensors:
  pose: {C: [[1, 0]], source: {topic: odom, type: nav_msgs/Odometry, fields: [pose.pose.position.x], scale: [2]}}
  wheel: {C: [[0, 1]], source: {topic: odom, type: nav_msgs/Odometry, fields: [twist.twist.linear.x]}}
  high: {C: [[1, 0]], measured: at_jumps, source: {topic: hit, type: geometry_msgs/PointStamped, fields: [point.x]}}
  fast: {C: [[0, 1]], measured: at_jumps, source: {topic: hit, type: geometry_msgs/PointStamped, fields: [point.y]}}
inputs:
  u: {topic: push, type: geometry_msgs/TwistStamped, fields: [twist.linear.x]}
  w: {topic: push, type: geometry_msgs/TwistStamped, fields: [twist.angular.z], offset: [1]}
jumps: {topic: jumps}
scenario:
  duration: 0.5
  seed: 3
  initial_state: {x: 1, v: 2}
  input: {rate: 10, formulas: {u: 3, w: -3}}
  sensors:
    pose: {schedule: {uniform: [0.05, 0.1]}, noise: {uniform: 0.1}}
    wheel: {schedule: {uniform: [0.05, 0.1]}}
  jumps: {schedule: {period: 0.2}}
)yaml";

TEST(SharedMessagesTest, SensorsAndInputsOfOneTopicShareMessages) {
  SharedMessages messages(test::parse_scenario(kOdometry));
  const auto& odometry = messages.on("odom");
  ASSERT_LE(5u, odometry.size());
  for (const auto& readings : odometry) {
    ASSERT_EQ(2u, readings.size());
    ASSERT_EQ(1u, readings[0].size());
    EXPECT_NEAR(1.2, readings[0][0], 0.4);
    EXPECT_NEAR(2.0, std::abs(readings[1][0]), 1e-12);
  }
  ASSERT_EQ(6u, messages.on("push").size());
  EXPECT_EQ((std::vector<std::vector<double>>{{3.0}, {-3.0}}), messages.on("push").front());
  ASSERT_EQ(2u, messages.on("hit").size());
  const auto& hit = messages.on("hit").front();
  EXPECT_NEAR(2.0, hit[0][0], 1e-12);  // fast, the first by name
  EXPECT_NEAR(1.4, hit[1][0], 1e-12);
}

TEST(SharedMessagesTest, NoSensorChangesWhatAnotherDraws) {
  const auto alone = test::replaced(kOdometry, "wheel: {C: [[0, 1]], source: {topic: odom",
                                    "wheel: {C: [[0, 1]], source: {topic: wheel");
  SharedMessages shared(test::parse_scenario(kOdometry));
  SharedMessages apart(test::parse_scenario(alone));
  ASSERT_EQ(shared.on("odom").size(), apart.on("odom").size());
  EXPECT_EQ(shared.arrivals_on("odom"), apart.arrivals_on("odom"));
  for (std::size_t i = 0; i < apart.on("odom").size(); ++i) {
    EXPECT_NEAR(apart.on("odom")[i][0][0], shared.on("odom")[i][0][0], 1e-12);  // other steps
  }
}

TEST(SharedMessagesTest, WhatOneMessageCannotHoldIsRefused) {
  const test::Fault faults[] = {
      {"wheel: {schedule: {uniform: [0.05, 0.1]}",
       "wheel: {schedule: {period: 0.05}",
       {"sensors/wheel/schedule", "the times of scenario/sensors/pose/schedule", "'odom'",
        "a topic of its own", "other times"}},
      {"wheel: {schedule: {uniform: [0.05, 0.1]}",
       "wheel: {schedule: {uniform: [0.05, 0.1]}, loss: 0.5",
       {"scenario/sensors/wheel", "the latency, loss", "of sensor 'pose'", "others"}},
      {"topic: push, type: geometry_msgs/TwistStamped, fields: [twist.angular.z]",
       "topic: odom, type: nav_msgs/Odometry, fields: [twist.twist.angular.z]",
       {"scenario/input/rate", "the times of scenario/sensors/pose/schedule", "other times"}},
      {"fields: [twist.twist.linear.x]",
       "fields: [twist.twist.linear.x], stamp_offset: 0.01",
       {"sensors/wheel/source/stamp_offset", "that of sensor 'pose'", "another one"}},
      {"type: nav_msgs/Odometry, fields: [twist.twist.linear.x]",
       "type: geometry_msgs/TwistStamped, fields: [twist.linear.x]",
       {"sensors/wheel/source/topic", "a topic of its own", "sensors/pose/source", "another type"}},
      {"{topic: jumps}",
       "{topic: hit, type: geometry_msgs/PointStamped}",
       {"jumps/topic", "a topic of its own", "sensors/fast/source"}},
  };
  for (const test::Fault& changed : faults) {
    const std::string message = test::fault_of(
        [&] { test::parse_scenario(test::replaced(kOdometry, changed.from, changed.to)); });
    EXPECT_EQ("", test::missing_parts(changed, message)) << changed.to << "\n" << message;
  }
}

TEST(SharedMessagesTest, AFieldHasOneValue) {
  const auto fault = [](const std::vector<std::string>& fields) {
    std::vector<SimulatedReading> readings;
    for (const std::string& field : fields) {
      TopicSource source;
      source.type = "sensor_msgs/Imu";
      source.fields = {field};
      source.size = 1;
      source.path = "sensors/s/source";
      readings.push_back({source});
    }
    return test::fault_of([&] { MessageEncoder encoder(readings); });
  };
  EXPECT_EQ("no fault", fault({"orientation.yaw", "orientation.roll"}));
  EXPECT_EQ("no fault", fault({"orientation.x", "orientation.y"}));
  test::expect_parts(fault({"orientation.yaw", "orientation.yaw"}),
                     {"sensors/s/source/fields", "'orientation.yaw'", "another value sets"});
  test::expect_parts(fault({"orientation.yaw", "orientation.x"}), {"'orientation.x'"});
  test::expect_parts(fault({"orientation.x", "orientation.yaw"}), {"'orientation.yaw'"});
}

}  // namespace
}  // namespace sampled_data_observers
