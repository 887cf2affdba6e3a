#include "sampled_data_observers/config/frame_config.h"

#include <gtest/gtest.h>

#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::Fault;
using test::fault;
using test::parse;
using test::replaced;

const char kFramed[] = R"(
observer: ConstantGainObserver
plant: {states: [yaw], A: [[0]]}
sensors:
  imu:
    C: [[1]]
    source: {topic: pose, type: geometry_msgs/PoseStamped, fields: [pose.position.x], frame: map, body_frame: base_link, sensor_frame: camera, tf_timeout: 0.25}
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0.5]]}
static_transforms:
  - {frame: base_link, child_frame: camera, translation: [1, 2, 3], rotation: {roll: 0.1, pitch: 0.2, yaw: 0.3}}
  - {frame: camera, child_frame: lens, rotation: {yaw: 1}}
  - {frame: map, child_frame: odom}
)";

TEST(FrameConfigTest, ReadsEveryKey) {
  const ObserverConfig config = parse(kFramed);
  const SourceFrames& frames = config.sensors[0]->frames;
  EXPECT_EQ("map", frames.frame);
  EXPECT_EQ("base_link", frames.body_frame);
  EXPECT_EQ("camera", frames.sensor_frame);
  EXPECT_EQ(from_seconds(0.25), frames.timeout);
  ASSERT_EQ(3u, config.static_transforms.size());
  EXPECT_EQ("base_link", config.static_transforms[0].frame);
  EXPECT_EQ("camera", config.static_transforms[0].child_frame);
  EXPECT_EQ(Eigen::Vector3d(1, 2, 3), config.static_transforms[0].translation);
  EXPECT_EQ(Eigen::Vector3d(0.1, 0.2, 0.3), config.static_transforms[0].rotation);
  EXPECT_EQ(Eigen::Vector3d(0, 0, 1), config.static_transforms[1].rotation);
  EXPECT_EQ(Eigen::Vector3d::Zero(), config.static_transforms[2].translation);
}

TEST(FrameConfigTest, DefaultsAreDataAsTheyComeAndHalfASecond) {
  const char kFrames[] =
      ", frame: map, body_frame: base_link, sensor_frame: camera, tf_timeout: 0.25";
  const ObserverConfig as_it_comes = parse(replaced(kFramed, kFrames, ""));
  EXPECT_FALSE(as_it_comes.sensors[0]->frames.any());
  const ObserverConfig default_time = parse(replaced(kFramed, ", tf_timeout: 0.25", ""));
  EXPECT_EQ(from_seconds(0.5), default_time.sensors[0]->frames.timeout);
}

TEST(FrameConfigTest, RefusesFaults) {
  const Fault faults[] = {
      {"body_frame: base_link, ", "", {"sensor_frame: expected a body_frame beside it"}},
      {"frame: map, body_frame: base_link, sensor_frame: camera, ",
       "",
       {"tf_timeout: expected a frame"}},
      {"tf_timeout: 0.25", "tf_timeout: -1", {"tf_timeout: expected a number from 0"}},
      {"frame: map, body",
       "frame: /map, body",
       {"source/frame: expected", "without a slash", "'/map'"}},
      {"child_frame: lens", "child_frame: camera", {"static_transforms/2/child_frame", "'camera'"}},
      {"child_frame: lens", "child_frame: base_link", {"static_transforms/2/frame", "hang"}},
      {"child_frame: odom", "child_frame: map", {"static_transforms/3/frame", "'map'"}},
      {"child_frame: odom", "child: odom", {"static_transforms/3/child_frame", "missing"}},
      {"[1, 2, 3]", "[1, 2]", {"static_transforms/1/translation", "list of 3"}},
      {"{yaw: 1}", "{yav: 1}", {"static_transforms/2/rotation/yav", "unknown key"}},
      {"- {frame: map, child_frame: odom}", "- map", {"static_transforms/3", "a map of keys"}},
  };
  for (const Fault& expected : faults) {
    const std::string message = fault(replaced(kFramed, expected.from, expected.to));
    EXPECT_EQ("", test::missing_parts(expected, message)) << message;
  }
}

}  // namespace
}  // namespace sampled_data_observers
