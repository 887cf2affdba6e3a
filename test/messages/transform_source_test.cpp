// The pose of a frame in another, as tf has it, for a measurement.
#include "messages/transform_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "messages/simulated_messages.h"
#include "messages/source_reading.h"
#include "messages/time_conversion.h"
#include "sampled_data_observers/config/event_channels.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::fault;
using test::Fault;
using test::parse;
using test::replaced;

const char kTagged[] = R"(
observer: ConstantGainObserver
plant: {states: [x, yaw], A: [[0, 0], [0, 0]]}
sensors:
  tag:
    C: [[1, 0], [0, 1]]
    source: {type: tf, frame: map, child_frame: base_link, fields: [translation.x, rotation.yaw]}
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0.5, 0], [0, 0.5]]}
frame_id: world
outputs: {base_frame: base_link, position: {x: x}, tf: {mode: odom}}
)";

/// A turn about z, and a shift.
geometry_msgs::TransformStamped transform(const std::string& frame, const std::string& child,
                                          double x, double y, double yaw,
                                          Stamp stamp = test::kSecond) {
  geometry_msgs::TransformStamped result;
  result.header.frame_id = frame;
  result.header.stamp = to_ros_time(stamp);
  result.child_frame_id = child;
  result.transform.translation.x = x;
  result.transform.translation.y = y;
  result.transform.rotation.w = std::cos(yaw / 2.0);
  result.transform.rotation.z = std::sin(yaw / 2.0);
  return result;
}

tf2_msgs::TFMessage all_of(const std::vector<geometry_msgs::TransformStamped>& transforms) {
  tf2_msgs::TFMessage message;
  message.transforms = transforms;
  return message;
}

class TransformSourceTest : public testing::Test {
 protected:
  void know_static(const geometry_msgs::TransformStamped& known) {
    const bool is_static = true;
    transforms_->take(all_of({known}), is_static, test::kSecond);
  }

  test::Read read(const std::vector<geometry_msgs::TransformStamped>& message) {
    return test::read(*source_, all_of(message));
  }

  const TopicSource config_ = *parse(kTagged).sensors[0];
  std::shared_ptr<TransformBuffer> transforms_ =
      std::make_shared<TransformBuffer>(std::vector<StaticTransform>());
  std::unique_ptr<MessageSource> source_ = make_message_source(config_, transforms_);
};

TEST_F(TransformSourceTest, TheConfigurationNamesTheFramesAndYawIsAnAngle) {
  EXPECT_EQ("/tf", config_.topic);
  EXPECT_EQ("tf2_msgs/TFMessage", config_.type);
  EXPECT_EQ("map", config_.frames.frame);
  EXPECT_EQ("base_link", config_.frames.child_frame);
  EXPECT_TRUE(has_frames(parse(kTagged)));
  EXPECT_EQ((std::vector<bool>{false, true}), parse(kTagged).plant->sensors()[0].angular);
}

TEST_F(TransformSourceTest, EachTransformOfThePairIsAnEvent) {
  const test::Read direct = read(
      {transform("odom", "wheel", 5.0, 0.0, 1.0), transform("map", "base_link", 2.0, 0.0, 0.5)});
  EXPECT_EQ(Reading::kEvent, direct.reading);
  EXPECT_EQ(test::kSecond, direct.event.stamp);
  ASSERT_EQ(2u, direct.values.size());
  EXPECT_EQ(2.0, direct.values[0]);
  EXPECT_NEAR(0.5, direct.values[1], 1e-15);
  EXPECT_EQ(3.0, read({transform("/map", "/base_link", 3.0, 0.0, 0.5)}).values[0]);
}

TEST_F(TransformSourceTest, OthersArePassedOver) {
  EXPECT_EQ(Reading::kPassedOver, read({transform("map", "other_robot", 2.0, 0.0, 0.5),
                                        transform("base_link", "wheel", 2.0, 0.0, 0.5)})
                                      .reading);
  EXPECT_EQ(Reading::kPassedOver, read({}).reading);
}

TEST_F(TransformSourceTest, StaticTransformsLeadToIt) {
  know_static(transform("map", "mocap", 10.0, 1.0, std::acos(0.0)));
  know_static(transform("marker", "base_link", 1.0, 0.0, 0.25));
  const test::Read read = this->read({transform("mocap", "marker", 3.0, 0.0, std::acos(0.0))});
  ASSERT_EQ(2u, read.values.size());
  // The marker is at (10, 4) in the map and looks along -x; the body is 1 m ahead of it.
  EXPECT_NEAR(9.0, read.values[0], 1e-14);
  EXPECT_NEAR(std::acos(-1.0) + 0.25 - 2.0 * std::acos(-1.0), read.values[1], 1e-14);
}

/// As a message of a sensor waits for its frame.
TEST_F(TransformSourceTest, ItWaitsForTheStaticTransformThatIsMissing) {
  const std::vector<geometry_msgs::TransformStamped> message = {
      transform("mocap", "base_link", 3.0, 0.0, 0.0)};
  const test::Read early = read(message);
  EXPECT_EQ(Reading::kNoTransform, early.reading);
  EXPECT_EQ(test::kSecond, early.event.stamp);
  std::string missing;
  source_->name_missing_transform(test::sent(*source_, all_of(message)), test::kSecond, missing);
  EXPECT_EQ("mocap -> map", missing);
  know_static(transform("map", "mocap", 10.0, 0.0, 0.0));
  EXPECT_EQ(13.0, read(message).values[0]);
}

TEST_F(TransformSourceTest, ATransformThatMovesIsNoStaticOne) {
  const bool is_static = true;
  transforms_->take(all_of({transform("map", "odom", 1.0, 0.0, 0.0)}), !is_static, test::kSecond);
  EXPECT_EQ(Reading::kNoTransform, read({transform("odom", "base_link", 3.0, 0.0, 0.0)}).reading);
}

TEST_F(TransformSourceTest, OfSeveralInOneMessageTheNewestCounts) {
  const test::Read read = this->read({transform("map", "base_link", 2.0, 0.0, 0.0, 9),
                                      transform("map", "base_link", 1.0, 0.0, 0.0, 8)});
  EXPECT_EQ(9, read.event.stamp);
  EXPECT_EQ(2.0, read.values[0]);
}

TEST_F(TransformSourceTest, WhatIsNoRotationOrHasNoStampIsRejected) {
  geometry_msgs::TransformStamped odd = transform("map", "base_link", 2.0, 0.0, 0.0);
  odd.transform.rotation.w = 2.0;
  EXPECT_FALSE(std::isfinite(read({odd}).values[1]));
  odd.transform.rotation.w = 0.0;
  EXPECT_FALSE(std::isfinite(read({odd}).values[1]));
  EXPECT_EQ(0, read({transform("map", "base_link", 2.0, 0.0, 0.0, 0)}).event.stamp);
}

TEST_F(TransformSourceTest, StampsAndValuesAreCorrectedAndThinned) {
  TopicSource corrected = config_;
  corrected.stamp_offset = 5;
  corrected.correction.scale = Eigen::Vector2d(2.0, 1.0);
  corrected.min_interval = 100;
  source_ = make_message_source(corrected, transforms_);
  const test::Read first = read({transform("map", "base_link", 2.0, 0.0, 0.0, 1000)});
  EXPECT_EQ(1005, first.event.stamp);
  EXPECT_EQ(4.0, first.values[0]);
  EXPECT_EQ(Reading::kPassedOver,
            read({transform("map", "base_link", 2.0, 0.0, 0.0, 1050)}).reading);
}

TEST_F(TransformSourceTest, ReadingAllocatesNothing) {
  const MessagePointer message =
      test::sent(*source_, all_of({transform("map", "base_link", 2.0, 0.0, 0.5)}));
  const std::size_t before = test::allocations();
  Event event;
  EXPECT_EQ(Reading::kEvent, source_->read(message, 0, event));
  EXPECT_TRUE(test::allocations() == before || !test::allocations_are_counted());
}

TEST_F(TransformSourceTest, SimulatedOnesAreReadBack) {
  SimulatedMessage message;
  message.stamp = test::kSecond;
  message.values = {1.5, -0.75};
  const test::Read read = test::read(*source_, MessageEncoder({{config_}}).encode(message));
  ASSERT_EQ(2u, read.values.size());
  EXPECT_EQ(test::kSecond, read.event.stamp);
  EXPECT_EQ(1.5, read.values[0]);
  EXPECT_NEAR(-0.75, read.values[1], 1e-15);
}

TEST_F(TransformSourceTest, FaultsSayWhatThereIs) {
  const Fault faults[] = {
      {"frame: map, ", "", {"sensors/tag/source/frame: expected a name of a frame", "missing"}},
      {"child_frame: base_link, ", "", {"source/child_frame: expected a name of a frame"}},
      {"child_frame: base_link, ", "child_frame: map, ", {"child_frame: expected another frame"}},
      {"type: tf,", "type: tf, topic: tf,", {"source/topic: expected none", "on /tf"}},
      {"type: tf,", "type: tf, body_frame: base,", {"source/body_frame", "unknown key"}},
      {"frame_id: world", "frame_id: map", {"child_frame: expected a transform that others"}},
  };
  for (const Fault& expected : faults) {
    const std::string message = fault(replaced(kTagged, expected.from, expected.to));
    EXPECT_EQ("", test::missing_parts(expected, message)) << message;
  }
  TopicSource other = config_;
  other.fields = {"translation.x", "rotation.heading"};
  test::expect_parts(test::fault_of([&] { make_message_source(other, transforms_); }),
                     {"geometry_msgs/Transform", "rotation.yaw", "'rotation.heading'"});
}

}  // namespace
}  // namespace sampled_data_observers
