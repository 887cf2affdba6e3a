// Samples late, out of order, duplicated, with NaN, of wrong size, without stamp and in the future,
// to a nodelet in a manager: what it says of each, and that only the good ones count.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "messages/time_conversion.h"
#include "ros/observer_client.h"
#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/runtime/observer_runtime.h"

namespace sampled_data_observers {
namespace {

TEST(BadInputTest, OnlyTheGoodEventsCountAndEachHasItsStatus) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  test::ObserverClient client;
  ASSERT_TRUE(client.connect());

  const ros::Time start = ros::Time::now() - ros::Duration(5.0);
  const auto at = [&](double seconds) { return start + ros::Duration(seconds); };

  EXPECT_EQ(EventStatus::USED, client.sample(at(0.0), {1.0}).outcome);
  EXPECT_EQ(EventStatus::USED, client.input(at(0.1), 0.5).outcome);
  EXPECT_EQ(EventStatus::USED, client.sample(at(1.0), {2.0}).outcome);
  EXPECT_EQ(EventStatus::USED, client.jump(at(1.5)).outcome);
  const EventStatus late = client.sample(at(0.4), {1.4});
  EXPECT_EQ(EventStatus::USED_LATE, late.outcome);
  EXPECT_EQ(2u, late.rewound);
  EXPECT_NEAR(0.4, late.interval, 1e-9);
  EXPECT_EQ(EventStatus::INTERVAL_WITHIN, late.interval_check);
  EXPECT_GT(late.latency, 4.0);
  EXPECT_EQ(EventStatus::DUPLICATE, client.sample(at(0.4), {1.4}).outcome);
  EXPECT_EQ(EventStatus::DUPLICATE, client.jump(at(1.5)).outcome);
  EXPECT_EQ(EventStatus::NOT_FINITE, client.sample(at(2.0), {kNaN}).outcome);
  EXPECT_EQ(EventStatus::NOT_FINITE, client.sample(at(2.0), {kInfinity}).outcome);
  EXPECT_EQ(EventStatus::NOT_FINITE, client.input(at(2.0), kNaN).outcome);
  EXPECT_EQ(EventStatus::WRONG_SIZE, client.sample(at(2.0), {}).outcome);
  EXPECT_EQ(EventStatus::WRONG_SIZE, client.sample(at(2.0), {1.0, 2.0}).outcome);
  EXPECT_EQ(EventStatus::NO_STAMP, client.sample(ros::Time(), {1.0}).outcome);
  EXPECT_EQ(EventStatus::NO_STAMP, client.jump(ros::Time()).outcome);
  ros::Time garbage;
  garbage.sec = garbage.nsec = 0xFFFFFFFFu;
  EXPECT_EQ(EventStatus::NO_STAMP, client.sample(garbage, {1.0}).outcome);
  EXPECT_FALSE(client.get_estimate(garbage).success);
  EXPECT_EQ(EventStatus::IN_FUTURE, client.sample(at(1000.0), {1.0}).outcome);
  EXPECT_EQ(EventStatus::TOO_OLD, client.sample(at(-1000.0), {1.0}).outcome);
  const EventStatus last = client.sample(at(2.5), {0.0});
  EXPECT_EQ(EventStatus::USED, last.outcome);
  EXPECT_EQ(EventStatus::INTERVAL_LONG, last.interval_check);
  EXPECT_EQ("position", last.source);
  EXPECT_EQ(EventStatus::SAMPLE, last.kind);
  EXPECT_EQ(EventStatus::USED_LATE, client.sample(at(2.0), {0.5}).outcome);

  // The same good events in order, in this process.
  const ObserverConfig config = read_observer_config(
      std::vector<std::string>{std::string(SDO_SOURCE_DIR) + "/test/ros/position.yaml"},
      no_plant_plugins);
  Estimator reference(config.law, config.options);
  const auto take = [&](double seconds, EventKind kind, std::vector<double> values) {
    const Stamp stamp = to_stamp(at(seconds));
    ASSERT_TRUE(
        reference
            .submit({stamp, kind, 0, values.data(), static_cast<Eigen::Index>(values.size())},
                    stamp)
            .used());
  };
  take(0.0, EventKind::kSample, {1.0});
  take(0.1, EventKind::kInput, {0.5});
  take(0.4, EventKind::kSample, {1.4});
  take(1.0, EventKind::kSample, {2.0});
  take(1.5, EventKind::kJump, {});
  take(2.0, EventKind::kSample, {0.5});
  take(2.5, EventKind::kSample, {0.0});

  Estimate expected = reference.make_estimate();
  for (double seconds = 0.0; seconds < 4.0; seconds += 0.0371) {
    const GetEstimate::Response found = client.get_estimate(at(seconds));
    ASSERT_TRUE(found.success) << found.message;
    reference.estimate_at(to_stamp(at(seconds)), expected);
    EXPECT_EQ(expected.counts.events, found.estimate.events);
    ASSERT_EQ(2u, found.estimate.state.size());
    EXPECT_EQ(0,
              std::memcmp(expected.state.data(), found.estimate.state.data(), 2 * sizeof(double)))
        << seconds;
  }
  const auto settled = [&] {
    return !client.estimates.empty() && client.estimates.back().events == 7;
  };
  EXPECT_TRUE(test::spin_until(settled));
  for (const StateEstimate& estimate : client.estimates) {
    for (const double value : estimate.state) EXPECT_TRUE(std::isfinite(value));
  }
}

}  // namespace
}  // namespace sampled_data_observers
