// Jumps from messages that are jumps, and from signals that show them.
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <sampled_data_observers/JumpEvent.h>
#include <sampled_data_observers/Measurement.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Header.h>
#include <std_msgs/Time.h>

#include <cmath>

#include "messages/source_reading.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"

namespace sampled_data_observers {
namespace {

using test::expect_parts;
using test::fault_of;
using test::kStamp;
using test::Read;
using test::read;
using test::source;

template <class M>
TopicSource jumps(const std::vector<std::string>& fields) {
  TopicSource result = source<M>(fields);
  result.of_jumps = true;
  result.stamped_on_receipt = false;
  return result;
}

TEST(JumpSourceTest, BareStampsAreJumps) {
  std_msgs::Header header;
  header.stamp.fromNSec(kStamp);
  const Read by_header =
      read(*make_message_source(jumps<std_msgs::Header>({})), header, EventKind::kJump);
  EXPECT_EQ(Reading::kEvent, by_header.reading);
  EXPECT_EQ(kStamp, by_header.event.stamp);
  EXPECT_EQ(std::nullopt, by_header.event.mode);
  EXPECT_EQ(0, by_header.event.size);
  std_msgs::Time time;
  time.data.fromNSec(kStamp);
  const Read by_time =
      read(*make_message_source(jumps<std_msgs::Time>({})), time, EventKind::kJump);
  EXPECT_EQ(kStamp, by_time.event.stamp);
  EXPECT_EQ(0, by_time.event.size);
}

TEST(JumpSourceTest, JumpEventsMayTakeJumpsBack) {
  JumpEvent message;
  message.header.stamp.fromNSec(kStamp);
  message.index = 7;
  const auto kind = [&] {
    const Read jump = read(*make_message_source(jumps<JumpEvent>({})), message, EventKind::kJump);
    EXPECT_EQ(Reading::kEvent, jump.reading);
    EXPECT_EQ(7u, jump.event.index);
    return jump.event.kind;
  };
  EXPECT_EQ(EventKind::kJump, kind());
  message.withdraw = 1;
  EXPECT_EQ(EventKind::kWithdrawal, kind());
}

TEST(JumpSourceTest, FieldsAreModeAndOutputs) {
  TopicSource switching = jumps<geometry_msgs::PointStamped>({"point.z"});
  switching.has_mode = true;
  switching.mode = "point.x";
  geometry_msgs::PointStamped message;
  message.point.x = 2.0;
  message.point.z = 0.5;
  const Read jump = read(*make_message_source(switching), message, EventKind::kJump);
  EXPECT_EQ((std::vector<double>{0.5}), jump.values);
  EXPECT_EQ(2.0, jump.event.mode);
  switching.mode = "";
  expect_parts(fault_of([&] { make_message_source(switching); }), {"source/mode", "found none"});
}

TEST(JumpSourceTest, JumpEventsHaveTheirValuesInOrder) {
  TopicSource own = jumps<JumpEvent>({});
  own.mode = "mode";
  expect_parts(fault_of([&] { make_message_source(own); }), {"source/mode", "no fields"});
}

TEST(DetectedJumpsTest, AreTheCrossingsOfTheSignal) {
  TopicSource imu = jumps<sensor_msgs::Imu>({"linear_acceleration.x"});
  DetectorConfig detector;
  detector.signal = std::make_shared<const AffineMap>(Eigen::MatrixXd::Constant(1, 1, 2.0));
  detector.options.threshold = 10.0;
  detector.jump_back_tolerance = 100;
  imu.detector = detector;
  const auto source = make_message_source(imu);
  const auto reading = [&](Stamp stamp, double x, Stamp receipt) {
    sensor_msgs::Imu message;
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
    message.linear_acceleration.x = x;
    return read(*source, message, EventKind::kJump, receipt);
  };
  EXPECT_EQ(Reading::kPassedOver, reading(1000, 0.0, 2000).reading);
  EXPECT_EQ(Reading::kOutOfOrder, reading(1000, 8.0, 2001).reading);
  EXPECT_EQ(Reading::kInFuture, reading(600'000'000, 8.0, 2001).reading);
  EXPECT_EQ(Reading::kNotFinite, reading(1500, std::nan(""), 2002).reading);
  const Read jump = reading(2000, 10.0, 2003);
  EXPECT_EQ(Reading::kEvent, jump.reading);
  EXPECT_EQ(1500, jump.event.stamp);
  EXPECT_EQ(0, jump.event.size);
  // The clock is corrected: what was before goes on counting.
  EXPECT_EQ(Reading::kPassedOver, reading(2500, 0.0, 2004).reading);
  EXPECT_EQ(2750, reading(3000, 10.0, 1950).event.stamp);
  // The clock is set back: what was before counts no more.
  EXPECT_EQ(Reading::kPassedOver, reading(100, 0.0, 200).reading);
  EXPECT_EQ(150, reading(200, 10.0, 201).event.stamp);
  // A simulated clock has not begun.
  EXPECT_EQ(Reading::kPassedOver, reading(600'000'000, 0.0, 0).reading);
  EXPECT_EQ(Reading::kEvent, reading(600'001'000, 10.0, 0).reading);
}

TEST(DetectedJumpsTest, CarryTheOutputsThatTheirMessageTells) {
  TopicSource heights = jumps<Measurement>({"values.1", "values.0"});
  DetectorConfig detector;
  detector.signal = std::make_shared<const AffineMap>(Eigen::RowVector2d(1.0, 0.0));
  detector.outputs = std::make_shared<const AffineMap>(Eigen::RowVector2d(1.0, 10.0));
  heights.detector = detector;
  const auto source = make_message_source(heights);
  const auto reading = [&](std::uint64_t stamp, const std::vector<double>& values) {
    Measurement message;
    message.header.stamp.fromNSec(stamp);
    message.values = values;
    return read(*source, message, EventKind::kJump);
  };
  EXPECT_EQ(Reading::kPassedOver, reading(1000, {0.0, -1.0}).reading);
  EXPECT_EQ(Reading::kNoField, reading(1500, {0.0}).reading);
  const Read jump = reading(2000, {0.5, 1.0});
  EXPECT_EQ(Reading::kEvent, jump.reading);
  EXPECT_EQ(1500, jump.event.stamp);
  EXPECT_EQ((std::vector<double>{6.0}), jump.values);
}

TEST(DetectedJumpsTest, OutputsOfAStepAreThoseBeforeItAndTheModeIsThatAfterIt) {
  TopicSource signal = jumps<Measurement>({"values.0", "values.1"});
  DetectorConfig detector;
  detector.signal = std::make_shared<const AffineMap>(Eigen::RowVector2d(1.0, 0.0));
  detector.outputs = std::make_shared<const AffineMap>(Eigen::RowVector2d(0.0, 1.0));
  detector.mode = std::make_shared<const AffineMap>(Eigen::RowVector2d(1.0, 0.0));
  detector.options.kind = JumpDetector::Kind::kStep;
  detector.options.threshold = 0.5;
  detector.options.window = 3;
  signal.detector = detector;
  const auto source = make_message_source(signal);
  int jumps = 0;
  for (int i = 1; i <= 60; ++i) {
    Measurement message;
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(1000 * i));
    message.values = {i > 25 ? 5.0 : 1.0, 100.0 + i};
    if (i % 7 == 0) {
      // As if it had not come.
      Measurement bad = message;
      bad.values[0] = std::nan("");
      EXPECT_EQ(Reading::kNotFinite, read(*source, bad, EventKind::kJump).reading);
    }
    const Read jump = read(*source, message, EventKind::kJump);
    if (jump.reading != Reading::kEvent) continue;
    ++jumps;
    EXPECT_EQ(25'500, jump.event.stamp);
    EXPECT_EQ((std::vector<double>{125.0}), jump.values);
    EXPECT_EQ(5.0, jump.event.mode);
  }
  EXPECT_EQ(1, jumps);
}

TEST(DetectedJumpsTest, ReadingAllocatesNothing) {
  TopicSource signal = jumps<Measurement>({"values.0"});
  DetectorConfig detector;
  detector.signal = std::make_shared<const AffineMap>(Eigen::MatrixXd::Constant(1, 1, 1.0));
  detector.outputs = detector.signal;
  detector.options.kind = JumpDetector::Kind::kStep;
  detector.options.threshold = 0.5;
  detector.options.window = 10;
  detector.options.noise_factor = 5.0;
  detector.options.noise_samples = 50;
  signal.detector = detector;
  const auto source = make_message_source(signal);
  std::vector<MessagePointer> messages;
  for (int i = 1; i <= 500; ++i) {
    Measurement message;
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(1000 * i));
    message.values = {i / 100 % 2 == 0 ? 0.0 : 1.0};
    messages.push_back(test::sent(*source, message));
  }
  // The second time round the clock is set back.
  int jumps = 0;
  const std::size_t before = test::allocations();
  for (const Stamp receipt : {Stamp{10'000'000'000}, Stamp{1'000'000}}) {
    for (const auto& message : messages) {
      Event event;
      event.kind = EventKind::kJump;
      jumps += source->read(message, receipt, event) == Reading::kEvent ? 1 : 0;
    }
  }
  EXPECT_EQ(before, test::allocations());
  EXPECT_EQ(4, jumps);
}

TEST(DetectedJumpsTest, TheEnergyBetweenThemIsAFormulaOfTheFields) {
  TopicSource signal = jumps<Measurement>({"values.0", "values.1"});
  DetectorConfig detector;
  detector.signal = std::make_shared<const AffineMap>(Eigen::RowVector2d(1.0, 0.0));
  detector.energy = std::make_shared<const AffineMap>(Eigen::RowVector2d(0.0, 2.0));
  detector.options.least_energy = 6.0;
  signal.detector = detector;
  const auto source = make_message_source(signal);
  const auto reading = [&](std::uint64_t stamp, double value, double half_energy) {
    Measurement message;
    message.header.stamp.fromNSec(stamp);
    message.values = {value, half_energy};
    return read(*source, message, EventKind::kJump).reading;
  };
  EXPECT_EQ(Reading::kPassedOver, reading(1000, -1.0, 2.0));
  EXPECT_EQ(Reading::kPassedOver, reading(2000, 1.0, 2.0));
  EXPECT_EQ(Reading::kPassedOver, reading(3000, -1.0, 3.0));
  EXPECT_EQ(Reading::kEvent, reading(4000, 1.0, 2.0));
}

}  // namespace
}  // namespace sampled_data_observers
