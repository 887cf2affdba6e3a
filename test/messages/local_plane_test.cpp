// Fixes of satellite navigation as places in the plane that touches the earth at a datum.
#include "messages/local_plane.h"

#include <gtest/gtest.h>
#include <sensor_msgs/NavSatFix.h>

#include <cmath>
#include <limits>

#include "messages/simulated_messages.h"
#include "messages/source_reading.h"
#include "messages/time_conversion.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::kStamp;
using test::source;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

sensor_msgs::NavSatFix fix(double latitude, double longitude, double altitude,
                           Stamp stamp = kStamp) {
  sensor_msgs::NavSatFix message;
  message.header.stamp = to_ros_time(stamp);
  message.latitude = latitude;
  message.longitude = longitude;
  message.altitude = altitude;
  return message;
}

/// In the frame of the earth's centre, by the ellipsoid's own formula.
Eigen::Vector3d from_centre(double latitude, double longitude, double altitude) {
  const double a = 6378137.0;
  const double f = 1.0 / 298.257223563;
  const double e2 = f * (2.0 - f);
  const double phi = latitude * M_PI / 180.0;
  const double lambda = longitude * M_PI / 180.0;
  const double N = a / std::sqrt(1.0 - e2 * std::sin(phi) * std::sin(phi));
  return {(N + altitude) * std::cos(phi) * std::cos(lambda),
          (N + altitude) * std::cos(phi) * std::sin(lambda),
          (N * (1.0 - e2) + altitude) * std::sin(phi)};
}

class Receiver {
 public:
  explicit Receiver(const NavSatDatum& datum,
                    const std::vector<std::string>& fields = {"east", "north", "up"})
      : transforms_(std::make_shared<TransformBuffer>(std::vector<StaticTransform>(), datum)),
        source_(make_message_source(source<sensor_msgs::NavSatFix>(fields), transforms_)) {}

  test::Read read(const sensor_msgs::NavSatFix& message) { return test::read(*source_, message); }
  test::Read use(const sensor_msgs::NavSatFix& message) {
    test::Read result = read(message);
    source_->confirm();
    return result;
  }
  MessageSource& messages() { return *source_; }
  TransformBuffer& transforms() { return *transforms_; }

 private:
  std::shared_ptr<TransformBuffer> transforms_;
  std::unique_ptr<MessageSource> source_;
};

const NavSatDatum kVienna = {Eigen::Vector3d(48.3, 16.4, 180.0)};

TEST(LocalPlaneTest, GivesEastNorthAndUpOfAFixedDatum) {
  Receiver receiver(kVienna);
  const test::Read read = receiver.read(fix(48.3021, 16.3972, 195.0));
  ASSERT_EQ(3u, read.values.size());
  const Eigen::Vector3d d = from_centre(48.3021, 16.3972, 195.0) - from_centre(48.3, 16.4, 180.0);
  const double phi = 48.3 * M_PI / 180.0;
  const double lambda = 16.4 * M_PI / 180.0;
  EXPECT_NEAR(-std::sin(lambda) * d.x() + std::cos(lambda) * d.y(), read.values[0], 1e-8);
  EXPECT_NEAR(-std::sin(phi) * (std::cos(lambda) * d.x() + std::sin(lambda) * d.y()) +
                  std::cos(phi) * d.z(),
              read.values[1], 1e-8);
  EXPECT_NEAR(
      std::cos(phi) * (std::cos(lambda) * d.x() + std::sin(lambda) * d.y()) + std::sin(phi) * d.z(),
      read.values[2], 1e-8);
  EXPECT_EQ("[48.300000000, 16.400000000, 180.0000]", receiver.transforms().datum_text());
}

TEST(LocalPlaneTest, WhatIsNoFixIsRejected) {
  Receiver receiver(kVienna);
  sensor_msgs::NavSatFix message = fix(48.3, 16.4, 180.0);
  message.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
  EXPECT_EQ(Reading::kNoField, receiver.read(message).reading);
  EXPECT_TRUE(std::isnan(receiver.read(fix(kNotKnown, 16.4, 180.0)).values[0]));
  EXPECT_TRUE(std::isnan(receiver.read(fix(91.0, 16.4, 180.0)).values[1]));
}

TEST(LocalPlaneTest, AFixWithoutAltitudeHasThatOfTheDatum) {
  Receiver receiver(kVienna);
  const std::vector<double> with = receiver.read(fix(48.301, 16.401, 180.0)).values;
  const std::vector<double> without = receiver.read(fix(48.301, 16.401, kNotKnown)).values;
  EXPECT_EQ(with[0], without[0]);
  EXPECT_EQ(with[1], without[1]);
  EXPECT_TRUE(std::isnan(without[2]));
}

TEST(LocalPlaneTest, TheFirstGoodFixIsTheDatum) {
  Receiver receiver({});
  receiver.read(fix(10.0, 10.0, 0.0));  // rejected
  EXPECT_EQ("", receiver.transforms().datum_text());
  const test::Read first = receiver.use(fix(48.3, 16.4, 180.0));
  for (const double value : first.values) EXPECT_NEAR(0.0, value, 1e-8);
  EXPECT_EQ("[48.300000000, 16.400000000, 180.0000]", receiver.transforms().datum_text());
  const sensor_msgs::NavSatFix second = fix(48.31, 16.41, 190.0, kStamp + kNanosecondsPerSecond);
  EXPECT_EQ(Receiver(kVienna).read(second).values, receiver.use(second).values);
}

/// Else the datum would depend on gates and gains.
TEST(LocalPlaneTest, WhatOnlyTheEstimateKeepsOutIsAGoodFix) {
  for (const EventOutcome outcome : {EventOutcome::kUsed, EventOutcome::kUsedLate,
                                     EventOutcome::kGated, EventOutcome::kWouldOverflow}) {
    EXPECT_TRUE(is_good(outcome)) << describe(outcome);
  }
  for (const EventOutcome outcome :
       {EventOutcome::kDuplicate, EventOutcome::kTooOld, EventOutcome::kInFuture,
        EventOutcome::kNotFinite, EventOutcome::kNoField, EventOutcome::kOutOfLimits,
        EventOutcome::kNoCovariance, EventOutcome::kDisabled}) {
    EXPECT_FALSE(is_good(outcome)) << describe(outcome);
  }
}

/// Else the estimate would depend on which of two came first.
TEST(LocalPlaneTest, FixesFromBeforeTheFirstAreTooOldUntilTimeBeginsAnew) {
  Receiver receiver({});
  receiver.use(fix(48.3, 16.4, 180.0));
  const sensor_msgs::NavSatFix earlier = fix(48.31, 16.41, 190.0, kStamp - 1);
  EXPECT_EQ(Reading::kBeforeDatum, receiver.read(earlier).reading);
  EXPECT_EQ(EventOutcome::kTooOld, outcome_of(Reading::kBeforeDatum));
  receiver.transforms().clear();
  EXPECT_EQ(Receiver(kVienna).read(earlier).values, receiver.use(earlier).values);
}

TEST(LocalPlaneTest, SourcesShareTheDatum) {
  const auto transforms =
      std::make_shared<TransformBuffer>(std::vector<StaticTransform>(), NavSatDatum());
  const auto one = make_message_source(source<sensor_msgs::NavSatFix>({"east"}), transforms);
  const auto other = make_message_source(source<sensor_msgs::NavSatFix>({"north"}), transforms);
  test::read(*one, fix(48.3, 16.4, 180.0));
  one->confirm();
  const sensor_msgs::NavSatFix message = fix(48.31, 16.41, 180.0);
  EXPECT_EQ(Receiver(kVienna).read(message).values[1], test::read(*other, message).values[0]);
}

TEST(LocalPlaneTest, WithoutDatumAndForUnknownFieldsTheFaultSaysWhatThereIs) {
  const auto fault_of = [](const std::vector<std::string>& fields) {
    return test::fault_of([&] { make_message_source(source<sensor_msgs::NavSatFix>(fields)); });
  };
  test::expect_parts(fault_of({"east"}), {"sensors/s/source/fields", "navsat/datum", "'east'"});
  test::expect_parts(fault_of({"west"}), {"latitude", "east, north, up"});
}

TEST(LocalPlaneTest, ReadingAllocatesNothing) {
  Receiver receiver({});
  const MessagePointer message = test::sent(receiver.messages(), fix(48.3, 16.4, 180.0));
  const std::size_t before = test::allocations();
  Event event;
  for (int i = 0; i < 3; ++i) {
    receiver.messages().read(message, 0, event);
    receiver.messages().confirm();
  }
  EXPECT_TRUE(test::allocations() == before || !test::allocations_are_counted());
}

TEST(LocalPlaneTest, SimulatedPlacesAreReadBack) {
  Receiver receiver(kVienna, {"north", "up", "east", "status.service"});
  SimulatedMessage message;
  message.stamp = kStamp;
  message.values = {120.0, -3.0, -450.0, 5.0};
  const MessageEncoder encoder(
      {{source<sensor_msgs::NavSatFix>({"north", "up", "east", "status.service"})}}, kVienna);
  const test::Read read = test::read(receiver.messages(), encoder.encode(message));
  ASSERT_EQ(4u, read.values.size());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(message.values[i], read.values[i], 1e-6);
  EXPECT_EQ(kStamp, read.event.stamp);
  const std::string fault = test::fault_of(
      [] { MessageEncoder({{source<sensor_msgs::NavSatFix>({"east"})}}, NavSatDatum()); });
  test::expect_parts(fault, {"navsat/datum", "found datum: first_fix"});
}

const char kNavigated[] = R"(
observer: ConstantGainObserver
plant: {states: [x], A: [[0]]}
sensors:
  gps: {C: [[1]], source: {topic: fix, type: sensor_msgs/NavSatFix, fields: [east]}}
navsat: {datum: [48.3, 16.4, 180]}
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0.5]]}
)";

TEST(LocalPlaneTest, TheConfigurationHasTheDatum) {
  EXPECT_EQ(Eigen::Vector3d(48.3, 16.4, 180.0), test::parse(kNavigated).navsat->position);
  const std::string fixed = "[48.3, 16.4, 180]";
  EXPECT_FALSE(test::parse(test::replaced(kNavigated, fixed, "first_fix")).navsat->position);
  EXPECT_FALSE(
      test::parse(test::replaced(kNavigated, "navsat: {datum: " + fixed + "}", "")).navsat);
  const test::Fault faults[] = {
      {"[48.3, 16.4, 180]",
       "frist_fix",
       {"navsat/datum: expected first_fix, or [latitude", "'frist_fix'"}},
      {"[48.3, 16.4, 180]", "[16.4, 480.3, 0]", {"navsat/datum", "found another place"}},
      {"[48.3, 16.4, 180]", "[48.3, 16.4]", {"navsat/datum", "3"}},
      {"{datum: [48.3, 16.4, 180]}", "{}", {"navsat/datum: expected first_fix"}},
  };
  for (const test::Fault& expected : faults) {
    const std::string message = test::fault(test::replaced(kNavigated, expected.from, expected.to));
    EXPECT_EQ("", test::missing_parts(expected, message)) << message;
  }
}

}  // namespace
}  // namespace sampled_data_observers
