#include "sampled_data_observers/config/outputs_config.h"

#include <gtest/gtest.h>

#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

const char kOutputs[] = R"(
observer: ConstantGainObserver
plant: {states: [x, v, yaw], A: [[0, 1, 0], [0, 0, 0], [0, 0, 0]]}
sensors: {s: {C: [[1, 0, 0]], source: {topic: s}}}
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0.5], [0], [0]]}
frame_id: map
outputs:
  base_frame: base_link
  position: {x: x, z: 0.25}
  orientation: {yaw: yaw}
  linear_velocity: {x: v}
  velocity_frame: world
  pose_covariance_diagonal: [1, 2, 3, 4, 5, 6]
  odometry: {topic: odometry}
  twist: {topic: /twist}
  tf: {mode: map, odom_frame: odom, transform_time_offset: -0.25}
)";

TEST(OutputsConfigTest, ReadsEveryKey) {
  const OutputsConfig outputs = *test::parse(kOutputs).outputs;
  EXPECT_EQ(0, *outputs.body.position[0].state);
  EXPECT_FALSE(outputs.body.position[1].state);
  EXPECT_EQ(0.25, outputs.body.position[2].constant);
  EXPECT_EQ(2, *outputs.body.roll_pitch_yaw[2].state);
  EXPECT_FALSE(outputs.body.quaternion);
  EXPECT_EQ(1, *outputs.body.linear_velocity[0].state);
  EXPECT_TRUE(outputs.body.velocity_in_world);
  EXPECT_EQ((std::array<double, 6>{1, 2, 3, 4, 5, 6}), outputs.body.pose_variances);
  EXPECT_EQ("map", outputs.world_frame);
  EXPECT_EQ("base_link", outputs.base_frame);
  EXPECT_EQ("odometry", *outputs.odometry);
  EXPECT_FALSE(outputs.pose);
  EXPECT_EQ("/twist", *outputs.twist);
  EXPECT_EQ("odom", outputs.transform->odom_frame);
  EXPECT_EQ(-250'000'000, outputs.transform->time_offset);
  EXPECT_EQ(500'000'000, outputs.transform->timeout);
}

TEST(OutputsConfigTest, ReadsAQuaternion) {
  const OutputsConfig outputs =
      *test::parse(test::replaced(kOutputs, "orientation: {yaw: yaw}",
                                  "orientation: {x: 0, y: 0, z: v, w: x}"))
           .outputs;
  ASSERT_TRUE(outputs.body.quaternion);
  EXPECT_EQ(1, *(*outputs.body.quaternion)[2].state);
  EXPECT_EQ(0, *(*outputs.body.quaternion)[3].state);
}

TEST(OutputsConfigTest, TakesInputsWhereNoStateHasTheName) {
  const std::string driven =
      test::replaced(kOutputs, "states: [x, v, yaw],",
                     "states: [x, v, yaw], inputs: [u, w], B: [[0, 0], [1, 0], [0, 1]],");
  const std::string moved =
      test::replaced(driven, "linear_velocity: {x: v}", "linear_velocity: {x: v, y: w}");
  const BodyStates body = test::parse(moved).outputs->body;
  EXPECT_EQ(1, *body.linear_velocity[0].state);
  EXPECT_FALSE(body.linear_velocity[0].input);
  EXPECT_EQ(1, *body.linear_velocity[1].input);
  EXPECT_FALSE(body.linear_velocity[1].state);
  EXPECT_FALSE(body.linear_velocity[2].input);
  const std::string message = test::fault(test::replaced(moved, "y: w", "y: w1"));
  EXPECT_NE(std::string::npos, message.find("a state (x, v, yaw) or of an input (u, w)"))
      << message;
}

TEST(OutputsConfigTest, RefusesFaultsAndSaysWhatExists) {
  const std::vector<test::Fault> faults = {
      {"{x: x, z: 0.25}", "{x: x1}", {"test.yaml:", "outputs/position/x", "x, v, yaw", "'x1'"}},
      {"{yaw: yaw}", "{heading: yaw}", {"outputs/orientation/heading", "pitch, roll, w, x, y"}},
      {"{yaw: yaw}", "{z: yaw, w: v}", {"outputs/orientation/x", "quaternion"}},
      {"[1, 2, 3, 4, 5, 6]", "[1, 2]", {"outputs/pose_covariance_diagonal", "6"}},
      {"[1, 2, 3, 4, 5, 6]", "[1, 2, 3, 4, 5, -6]", {"pose_covariance_diagonal", "negative"}},
      {"velocity_frame: world", "velocity_frame: map", {"outputs/velocity_frame", "base, world"}},
      {"mode: map, odom_frame: odom", "mode: both", {"outputs/tf/mode", "odom, map", "'both'"}},
      {"mode: map, odom_frame: odom", "mode: map", {"outputs/tf/odom_frame", "missing"}},
      {"odom_frame: odom", "odom_frame: map", {"outputs/tf", "another odom_frame", "'map'"}},
      {"frame_id: map", "rate: 10", {"frame_id", "world frame"}},
      {"base_frame: base_link", "", {"outputs/base_frame", "missing"}},
      {"base_frame: base_link", "base_frame: map", {"outputs/base_frame", "another", "'map'"}},
      {"linear_velocity: {x: v}", "", {"outputs/linear_velocity", "twist"}},
      {"odometry: {topic: odometry}", "odometry: {}", {"outputs/odometry/topic", "missing"}},
  };
  for (const test::Fault& fault : faults) {
    const std::string message = test::fault(test::replaced(kOutputs, fault.from, fault.to));
    EXPECT_EQ("", test::missing_parts(fault, message)) << message;
  }
}

/// An integrator whose bound holds for all its samplings.
const char kBounded[] = R"(
observer: ConstantGainObserver
plant: {states: [x, y, yaw], A: [[0, 0, 0], [0, 0, 0], [0, 0, 0]]}
sensors: {s: {C: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], source: {topic: s}}}
sampling: {T1: 0.1, T2: 1}
gains: {L: [[0.5, 0, 0], [0, 0.5, 0], [0, 0, 0.5]]}
certificate:
  theorem: ferrante2016_theorem1
  plant: {file: plant.yaml, hash: HASH}
  T1: 0.1
  T2: 1
  decay: 0.1
  P: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
error_assumptions: {initial_error: 1, noise: 0, disturbance: 0}
frame_id: map
outputs:
  base_frame: base_link
  position: {x: x, y: y}
  orientation: {yaw: yaw}
  pose_covariance: guaranteed_ellipsoid
  odometry: {topic: odometry}
)";

TEST(OutputsConfigTest, APoseMayBeGivenTheEllipsoidOfItsError) {
  const auto with_own_hash = [](const std::string& text) {
    const std::string fault = test::fault(text);
    const std::string before = "plant/hash: expected ";
    const std::size_t begin = fault.find(before) + before.size();
    return test::replaced(
        text, "HASH",
        fault.substr(begin, fault.find_first_not_of("0123456789abcdef-", begin) - begin));
  };
  const std::string bounded = with_own_hash(kBounded);
  EXPECT_TRUE(test::parse(bounded).outputs->pose_is_bounded);
  const std::string ellipsoid = "pose_covariance: guaranteed_ellipsoid";
  EXPECT_FALSE(test::parse(test::replaced(bounded, ellipsoid, "pose_covariance: observer"))
                   .outputs->pose_is_bounded);
  EXPECT_FALSE(test::parse(test::replaced(bounded, ellipsoid, "")).outputs->pose_is_bounded);
  EXPECT_TRUE(test::parse(test::replaced(bounded, "{yaw: yaw}", "{pitch: yaw, roll: 0.1}"))
                  .outputs->pose_is_bounded);
  const std::vector<test::Fault> faults = {
      {"guaranteed_ellipsoid", "ellipse", {"outputs/pose_covariance", "guaranteed_ellipsoid"}},
      {"error_assumptions: {initial_error: 1, noise: 0, disturbance: 0}",
       "",
       {"outputs/pose_covariance", "error_assumptions and a certificate", "no such bound"}},
      {"odometry: {topic: odometry}",
       "tf: {mode: odom}",
       {"outputs/pose_covariance", "odometry or pose", "neither"}},
      {"{yaw: yaw}", "{yaw: yaw, pitch: y}", {"outputs/pose_covariance", "one state", "several"}},
      {"{yaw: yaw}",
       "{x: 0, y: 0, z: yaw, w: 1}",
       {"outputs/pose_covariance", "one state", "a quaternion of states"}},
  };
  for (const test::Fault& fault : faults) {
    const std::string message = test::fault(test::replaced(bounded, fault.from, fault.to));
    EXPECT_EQ("", test::missing_parts(fault, message)) << message;
  }
}

TEST(OutputsConfigTest, NeedsAnOutputAndAPose) {
  const char kStart[] = "rate: 10\nframe_id: map\noutputs:\n  base_frame: b\n";
  const std::string plant = test::replaced(kOutputs, "frame_id: map", "#");
  const std::string without_outputs = plant.substr(0, plant.find("outputs:"));
  EXPECT_FALSE(test::parse(without_outputs).outputs);
  EXPECT_NE(std::string::npos, test::fault(without_outputs + kStart + "  position: {x: x}\n")
                                   .find("one of odometry, pose, twist and tf"));
  EXPECT_NE(
      std::string::npos,
      test::fault(without_outputs + kStart + "  pose: {topic: pose}\n").find("outputs/position"));
}

}  // namespace
}  // namespace sampled_data_observers
