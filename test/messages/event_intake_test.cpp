// Messages that wait for their transforms; the topics' own path is in transforms_test.cpp.
#include "sampled_data_observers/messages/event_intake.h"

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "messages/source_reading.h"
#include "messages/time_conversion.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;

constexpr Duration kMillisecond = 1000000;

EventChannel camera(Duration min_interval = 0) {
  EventChannel channel;
  channel.name = "camera";
  channel.source.type = "geometry_msgs/PointStamped";
  channel.source.topic = "camera";
  channel.source.fields = {"point.x"};
  channel.source.size = 1;
  channel.source.frames.frame = "map";
  channel.source.frames.timeout = 500 * kMillisecond;
  channel.source.min_interval = min_interval;
  return channel;
}

class EventIntakeTest : public testing::Test {
 protected:
  struct Handled {
    Stamp stamp = 0;
    Reading reading = Reading::kEvent;
    double value = 0.0;
    std::string missing;
  };

  EventIntake intake(const EventChannel& channel) {
    return {channel, make_message_source(channel.source, transforms_),
            [this](const EventChannel& from, const Event& event, Reading reading,
                   const std::string& missing) {
              EXPECT_EQ("camera", from.name);
              const double value = reading == Reading::kEvent ? event.values[0] : 0.0;
              handled_.push_back({event.stamp, reading, value, missing});
              return reading == Reading::kEvent;
            }};
  }

  template <class M>
  MessagePointer sent(const M& message) const {
    TopicSource source = camera().source;
    source.type = ros::message_traits::DataType<M>::value();
    source.frames = {};
    source.of_jumps = true;  // so they need no fields
    source.fields.clear();
    return test::sent(*make_message_source(source), message);
  }

  MessagePointer point(Stamp stamp) const {
    geometry_msgs::PointStamped message;
    message.header.stamp = to_ros_time(stamp);
    message.header.frame_id = "camera";
    message.point.x = 1.0;
    return sent(message);
  }

  /// The camera stands in the map at x = 10 per second.
  void know_transform_at(Stamp stamp) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    message.transforms[0].header.stamp = to_ros_time(stamp);
    message.transforms[0].header.frame_id = "map";
    message.transforms[0].child_frame_id = "camera";
    message.transforms[0].transform.translation.x = 10.0 * to_seconds(stamp);
    message.transforms[0].transform.rotation.w = 1.0;
    transforms_->take(message, false, kSecond);
  }

  std::shared_ptr<TransformBuffer> transforms_ =
      std::make_shared<TransformBuffer>(std::vector<StaticTransform>());
  std::vector<Handled> handled_;
};

TEST_F(EventIntakeTest, WhatHasItsTransformBecomesAnEventAtOnce) {
  EventIntake intake = this->intake(camera());
  know_transform_at(kSecond);
  know_transform_at(2 * kSecond);
  intake.take(point(kSecond + kSecond / 2), 0, 2 * kSecond);
  ASSERT_EQ(1u, handled_.size());
  EXPECT_EQ(kSecond + kSecond / 2, handled_[0].stamp);
  EXPECT_NEAR(16.0, handled_[0].value, 1e-9);
}

TEST_F(EventIntakeTest, OthersWaitAndThenAreTransformedAtTheirOwnStamps) {
  EventIntake intake = this->intake(camera());
  know_transform_at(kSecond);
  intake.take(point(kSecond + 300 * kMillisecond), 0, kSecond + 310 * kMillisecond);
  intake.take(point(kSecond + 600 * kMillisecond), 0, kSecond + 610 * kMillisecond);
  intake.retry(kSecond + 700 * kMillisecond);
  EXPECT_TRUE(handled_.empty());
  know_transform_at(kSecond + 500 * kMillisecond);
  intake.retry(kSecond + 710 * kMillisecond);
  ASSERT_EQ(1u, handled_.size());
  EXPECT_NEAR(14.0, handled_[0].value, 1e-9);
  know_transform_at(kSecond + 700 * kMillisecond);
  intake.retry(kSecond + 720 * kMillisecond);
  ASSERT_EQ(2u, handled_.size());
  EXPECT_NEAR(17.0, handled_[1].value, 1e-9);
}

TEST_F(EventIntakeTest, WhatWaitedInVainIsReportedWithItsStamp) {
  EventIntake intake = this->intake(camera());
  intake.take(point(kSecond), 0, kSecond);
  intake.retry(kSecond + 500 * kMillisecond);
  EXPECT_TRUE(handled_.empty());
  intake.retry(kSecond + 501 * kMillisecond);
  ASSERT_EQ(1u, handled_.size());
  EXPECT_EQ(kSecond, handled_[0].stamp);
  EXPECT_EQ(Reading::kNoTransform, handled_[0].reading);
  EXPECT_EQ(EventOutcome::kNoTransform, outcome_of(handled_[0].reading));
  EXPECT_EQ("camera -> map", handled_[0].missing);
}

TEST_F(EventIntakeTest, WhatMayNotWaitIsReportedAtOnceWithTheFrameItHasNot) {
  EventChannel channel = camera();
  channel.source.frames.timeout = 0;
  EventIntake intake = this->intake(channel);
  geometry_msgs::PointStamped message;
  message.header.stamp = to_ros_time(kSecond);
  intake.take(sent(message), 0, kSecond);
  ASSERT_EQ(1u, handled_.size());
  EXPECT_EQ(Reading::kNoTransform, handled_[0].reading);
  EXPECT_EQ(kSecond, handled_[0].stamp);
  EXPECT_EQ("(no frame) -> map", handled_[0].missing);
}

TEST_F(EventIntakeTest, OfTwoTransformsThatWhichIsMissingIsNamed) {
  EventChannel channel = camera();
  channel.source.type = "geometry_msgs/PoseStamped";
  channel.source.fields = {"pose.position.x"};
  channel.source.frames.sensor_frame = "marker";
  channel.source.frames.body_frame = "base";
  channel.source.frames.timeout = 0;
  EventIntake intake = this->intake(channel);
  geometry_msgs::PoseStamped message;
  message.header.stamp = to_ros_time(kSecond);
  message.header.frame_id = "camera";
  message.pose.orientation.w = 1.0;
  intake.take(sent(message), 0, kSecond);
  know_transform_at(kSecond);
  intake.take(sent(message), 0, kSecond);
  ASSERT_EQ(2u, handled_.size());
  EXPECT_EQ("camera -> map", handled_[0].missing);
  EXPECT_EQ("base -> marker", handled_[1].missing);
}

TEST(FramePairTest, LongNamesAreCutToTheRoomThereIs) {
  std::string text;
  text.reserve(kLongestPair);
  const std::string name(1000, 'x');
  write_pair(name, name, text);
  EXPECT_EQ(kLongestPair, text.size());
}

TEST_F(EventIntakeTest, NothingWaitsAfterGivingUp) {
  EventIntake intake = this->intake(camera());
  intake.take(point(kSecond), 0, kSecond);
  intake.give_up();
  ASSERT_EQ(1u, handled_.size());
  EXPECT_EQ(Reading::kNoTransform, handled_[0].reading);
  know_transform_at(kSecond);
  intake.retry(kSecond);
  EXPECT_EQ(1u, handled_.size());
}

TEST_F(EventIntakeTest, AMessageWithoutStampWaitsForNothing) {
  EventIntake intake = this->intake(camera());
  intake.take(point(0), 0, kSecond);
  ASSERT_EQ(1u, handled_.size());
  EXPECT_EQ("", handled_[0].missing);
  EXPECT_EQ(Reading::kEvent, handled_[0].reading);  // which the estimator rejects
  EXPECT_EQ(0, handled_[0].stamp);
}

TEST_F(EventIntakeTest, WhatFoundNoTransformDoesNotTakeThePlaceOfTheNextMessage) {
  EventIntake intake = this->intake(camera(kSecond));
  intake.take(point(kSecond), 0, kSecond);
  intake.retry(kSecond + 501 * kMillisecond);
  know_transform_at(kSecond + 400 * kMillisecond);
  know_transform_at(kSecond + 900 * kMillisecond);
  intake.take(point(kSecond + 600 * kMillisecond), 0, kSecond + 900 * kMillisecond);
  intake.take(point(kSecond + 700 * kMillisecond), 0, kSecond + 900 * kMillisecond);
  ASSERT_EQ(2u, handled_.size());
  EXPECT_EQ(Reading::kNoTransform, handled_[0].reading);
  EXPECT_EQ(kSecond + 600 * kMillisecond, handled_[1].stamp);
}

TEST_F(EventIntakeTest, FramesOfATypeWithoutAnyAreRefused) {
  TopicSource source = camera().source;
  source.type = "std_msgs/Float64";
  source.fields = {"data"};
  source.stamped_on_receipt = true;
  source.origin = "file.yaml:3";
  source.path = "sensors/s/source";
  try {
    make_message_source(source, transforms_);
    FAIL() << "taken";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("sensors/s/source/frame: expected"))
        << error.what();
  }
}

}  // namespace
}  // namespace sampled_data_observers
