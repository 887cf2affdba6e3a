// R as messages have it.
#include "messages/message_covariance.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/NavSatFix.h>

#include <limits>

#include "messages/simulated_messages.h"
#include "messages/source_reading.h"
#include "messages/time_conversion.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::source;

using Numbers = std::vector<double>;

template <class M>
TopicSource with_covariance(const std::vector<std::string>& fields, double scale = 1.0,
                            double floor = 0.0) {
  TopicSource result = source<M>(fields);
  result.covariance = MessageCovariance{
      scale, Eigen::VectorXd::Constant(static_cast<Eigen::Index>(fields.size()), floor)};
  return result;
}

/// The lower triangle of R, or why there is none.
template <class M>
Numbers covariance_in(const TopicSource& wanted, const M& message,
                      Reading expected = Reading::kEvent) {
  const auto transforms = std::make_shared<TransformBuffer>(
      std::vector<StaticTransform>(), NavSatDatum{Eigen::Vector3d(48.0, 16.0, 0.0)});
  const auto messages = make_message_source(wanted, transforms);
  Event event;
  EXPECT_EQ(expected, messages->read(test::sent(*messages, message), 0, event));
  if (expected != Reading::kEvent) return {};
  EXPECT_EQ(static_cast<Eigen::Index>(wanted.size), event.size);
  return {event.values + event.size, event.values + event.size + event.covariance};
}

template <class M>
M stamped() {
  M message;
  message.header.stamp = to_ros_time(test::kStamp);
  return message;
}

nav_msgs::Odometry odometry() {
  auto message = stamped<nav_msgs::Odometry>();
  message.pose.pose.orientation.w = 1.0;
  for (std::size_t i = 0; i < 36; ++i) {
    message.pose.covariance[i] = i % 7 == 0 ? 1.0 + static_cast<double>(i / 7) : 0.0;
    message.twist.covariance[i] = i % 7 == 0 ? 10.0 + static_cast<double>(i / 7) : 0.0;
  }
  message.pose.covariance[5] = message.pose.covariance[30] = 0.25;  // x and yaw
  return message;
}

TEST(MessageCovarianceTest, PosesAndTwistsHaveTheirs) {
  EXPECT_EQ((Numbers{1.0, 0.25, 6.0, 0.0, 0.0, 15.0}),
            covariance_in(
                with_covariance<nav_msgs::Odometry>(
                    {"pose.pose.position.x", "pose.pose.orientation.yaw", "twist.twist.angular.z"}),
                odometry()));
}

TEST(MessageCovarianceTest, SoHaveImuNavSatFixAndVariances) {
  auto imu = stamped<sensor_msgs::Imu>();
  imu.orientation.w = 1.0;
  imu.orientation_covariance = {1, 0, 0, 0, 2, 0, 0, 0, 3};
  imu.angular_velocity_covariance = {4, 0.5, 0, 0.5, 5, 0, 0, 0, 6};
  EXPECT_EQ((Numbers{4.0, 0.5, 5.0, 0.0, 0.0, 3.0}),
            covariance_in(with_covariance<sensor_msgs::Imu>(
                              {"angular_velocity.x", "angular_velocity.y", "orientation.yaw"}),
                          imu));
  auto fix = stamped<sensor_msgs::NavSatFix>();
  fix.position_covariance = {1, 0.5, 0, 0.5, 2, 0, 0, 0, 3};
  fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_KNOWN;
  EXPECT_EQ((Numbers{2.0, 0.5, 1.0}),
            covariance_in(with_covariance<sensor_msgs::NavSatFix>({"north", "east"}), fix));
  auto pressure = stamped<sensor_msgs::FluidPressure>();
  pressure.variance = 9.0;
  EXPECT_EQ(
      (Numbers{9.0}),
      covariance_in(with_covariance<sensor_msgs::FluidPressure>({"fluid_pressure"}), pressure));
}

TEST(MessageCovarianceTest, ScalesOfTheSourceAndOfRAndTheFloorCount) {
  TopicSource wanted = with_covariance<nav_msgs::Odometry>(
      {"pose.pose.position.x", "pose.pose.orientation.yaw"}, 2.0, 20.0);
  wanted.correction.scale = Eigen::Vector2d(4.0, -0.5);
  wanted.correction.offset = Eigen::Vector2d(7.0, 7.0);
  EXPECT_EQ((Numbers{32.0, -1.0, 20.0}), covariance_in(wanted, odometry()));
}

TEST(MessageCovarianceTest, WhatIsNoCovarianceIsRejected) {
  const TopicSource wanted =
      with_covariance<nav_msgs::Odometry>({"pose.pose.position.x", "pose.pose.position.y"});
  nav_msgs::Odometry bad = odometry();
  for (const double variance : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity()}) {
    bad.pose.covariance[7] = variance;
    covariance_in(wanted, bad, Reading::kNoCovariance);
  }
  bad = odometry();
  bad.pose.covariance[6] = 2.0;  // above the root of 1 x 2
  covariance_in(wanted, bad, Reading::kNoCovariance);
  EXPECT_EQ(EventOutcome::kNoCovariance, outcome_of(Reading::kNoCovariance));
}

TEST(MessageCovarianceTest, AFloorTakesThePlaceOfZerosAndOfWhatIsNotKnown) {
  const auto floored = with_covariance<sensor_msgs::NavSatFix>({"east"}, 1.0, 4.0);
  auto fix = stamped<sensor_msgs::NavSatFix>();
  EXPECT_EQ((Numbers{4.0}), covariance_in(floored, fix));
  fix.position_covariance[0] = 100.0;  // of an unknown type
  EXPECT_EQ((Numbers{4.0}), covariance_in(floored, fix));
  covariance_in(with_covariance<sensor_msgs::NavSatFix>({"east"}), fix, Reading::kNoCovariance);
  fix.position_covariance[0] = -1.0;
  fix.position_covariance_type = 1;
  covariance_in(floored, fix, Reading::kNoCovariance);
}

TEST(MessageCovarianceTest, FieldsWithoutAreRefused) {
  for (const char* field : {"pose.pose.orientation.w", "pose.covariance.0"}) {
    test::expect_parts(
        test::fault_of([&] { make_message_source(with_covariance<nav_msgs::Odometry>({field})); }),
        {"sensors/s/source/fields", "gives a covariance of", field});
  }
  EXPECT_NE("no fault", test::fault_of([] {
              make_message_source(with_covariance<sensor_msgs::LaserScan>({"ranges.0"}));
            }));
}

TEST(MessageCovarianceTest, ReadingAllocatesNothing) {
  const auto messages =
      make_message_source(with_covariance<nav_msgs::Odometry>({"pose.pose.position.x"}));
  const MessagePointer message = test::sent(*messages, odometry());
  const std::size_t before = test::allocations();
  Event event;
  EXPECT_EQ(Reading::kEvent, messages->read(message, 0, event));
  EXPECT_TRUE(test::allocations() == before || !test::allocations_are_counted());
}

TEST(MessageCovarianceTest, SimulatedMessagesTellOfTheirNoise) {
  SimulatedMessage simulated;
  simulated.stamp = test::kStamp;
  simulated.values = {1.0, 2.0};
  TopicSource wanted = with_covariance<sensor_msgs::NavSatFix>({"east", "north"});
  wanted.correction.scale = Eigen::Vector2d(2.0, 1.0);
  const MessageEncoder encoder({{wanted, Eigen::Vector2d(0.25, 0.5)}},
                               NavSatDatum{Eigen::Vector3d(48.0, 16.0, 0.0)});
  EXPECT_EQ((Numbers{0.25, 0.0, 0.5}), covariance_in(wanted, encoder.encode(simulated)));
}

const char kFiltered[] = R"(
observer: HybridKalmanFilter
plant: {states: [x], A: [[0]]}
sensors:
  gps: {C: [[1]], source: {topic: odom, type: nav_msgs/Odometry, fields: [pose.pose.position.x]}}
sampling: {T1: 0.1, T2: 0.1}
gains: {P0: [[1]], Q: [[1]], R: {gps: {message: {scale: 2, floor: [0.5]}}}}
)";
const char kFromMessage[] = "{gps: {message: {scale: 2, floor: [0.5]}}}";

TEST(MessageCovarianceTest, TheConfigurationAsksForIt) {
  const ObserverConfig config = test::parse(kFiltered);
  EXPECT_EQ((MessageCovariance{2.0, Eigen::VectorXd::Constant(1, 0.5)}),
            *config.sensors[0]->covariance);
  const MessageCovariance plain{1.0, Eigen::VectorXd::Zero(1)};
  for (const char* text : {"message", "{gps: message}", "{gps: {message: {}}}"}) {
    EXPECT_EQ(plain,
              *test::parse(test::replaced(kFiltered, kFromMessage, text)).sensors[0]->covariance);
  }
  const ObserverConfig fixed = test::parse(test::replaced(kFiltered, kFromMessage, "[[1]]"));
  EXPECT_FALSE(fixed.sensors[0]->covariance);
}

TEST(MessageCovarianceTest, FaultsOfTheConfigurationSayWhatThereIs) {
  const test::Fault faults[] = {
      {"message: {scale", "massage: {scale", {"gains/R/gps"}},
      {kFromMessage,
       "{gps: messages}",
       {"gains/R/gps: expected a matrix, or message", "'messages'"}},
      {"floor: [0.5]", "floor: [-1]", {"gains/R/gps/message/floor", "not negative"}},
      {"scale: 2", "scale: 0", {"gains/R/gps/message/scale"}},
      {"topic: odom, type: nav_msgs/Odometry, fields: [pose.pose.position.x]",
       "topic: odom",
       {"sensors/gps/source/type: expected a message type with a covariance"}},
      {"topic: odom,", "topic: odom, frame: map,", {"source/frame: expected none", "'map'"}},
  };
  for (const test::Fault& expected : faults) {
    const std::string message = test::fault(test::replaced(kFiltered, expected.from, expected.to));
    EXPECT_EQ("", test::missing_parts(expected, message)) << message;
  }
}

}  // namespace
}  // namespace sampled_data_observers
