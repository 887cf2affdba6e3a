// With reset_on_time_jump_back, under a clock that this test publishes: a bag that loops, a clock
// that stops and goes on, one that is set back a little, and one that jumps ahead.
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "messages/time_conversion.h"
#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

class TimeJumpsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    clock_publisher_ = handle_.advertise<rosgraph_msgs::Clock>("/clock", 10);
    ASSERT_TRUE(client_.connect());
    ASSERT_TRUE(test::spin_until([this] { return clock_publisher_.getNumSubscribers() >= 2; }));
  }

  /// Sets the clock again and again, as simulators do, until something holds.
  bool hold_clock_until(double seconds, const std::function<bool()>& done) {
    rosgraph_msgs::Clock message;
    message.clock = ros::Time(seconds);
    return test::spin_until([&] {
      clock_publisher_.publish(message);
      ros::WallDuration(0.005).sleep();
      return done();
    });
  }
  bool estimated_until(double seconds) const {
    return !client_.estimates.empty() &&
           client_.estimates.back().header.stamp == ros::Time(seconds);
  }
  EventStatus sample_at(double seconds, double value) {
    const std::size_t before = client_.statuses.size();
    EXPECT_TRUE(hold_clock_until(seconds, [&] { return estimated_until(seconds); }) ||
                client_.estimates.empty());
    client_.publish_sample(ros::Time(seconds), value);
    EXPECT_TRUE(hold_clock_until(seconds, [&] { return client_.statuses.size() > before; }));
    return client_.statuses.empty() ? EventStatus() : client_.statuses.back();
  }
  /// Plays one second of "bag" and returns what was estimated at its end.
  StateEstimate play(double start) {
    client_.estimates.clear();
    const std::size_t before = client_.statuses.size();
    hold_clock_until(start, [] { return ros::Time::now().toSec() > 0.0; });
    ros::WallDuration(0.2).sleep();  // the observer, too, hears the clock
    client_.publish_sample(ros::Time(start), 1.0);
    EXPECT_TRUE(hold_clock_until(start, [&] { return client_.statuses.size() > before; }));
    EXPECT_EQ(EventStatus::USED, client_.statuses.back().outcome);
    EXPECT_EQ(EventStatus::USED, sample_at(start + 0.5, 2.0).outcome);
    EXPECT_TRUE(hold_clock_until(start + 1.0, [&] { return estimated_until(start + 1.0); }));
    return client_.estimates.empty() ? StateEstimate() : client_.estimates.back();
  }

  ros::NodeHandle handle_;
  ros::Publisher clock_publisher_;
  test::ObserverClient client_;
};

TEST_F(TimeJumpsTest, ABagThatLoopsGivesTheSameEstimatesEachTime) {
  const StateEstimate first = play(100.0);
  EXPECT_EQ(51u, client_.estimates.size());
  EXPECT_EQ(ros::Time(100.0), client_.estimates.front().header.stamp);
  for (int loop = 0; loop < 2; ++loop) {
    const StateEstimate again = play(100.0);
    EXPECT_EQ(51u, client_.estimates.size());
    EXPECT_EQ(ros::Time(100.0), client_.estimates.front().header.stamp);
    EXPECT_EQ(first.state, again.state);
    EXPECT_EQ(2u, again.events);
  }

  // The clock stops for a while and goes on.
  const std::size_t before = client_.estimates.size();
  EXPECT_FALSE(test::spin_until([&] { return client_.estimates.size() > before; }, 0.3));
  EXPECT_TRUE(hold_clock_until(101.2, [&] { return estimated_until(101.2); }));
  EXPECT_EQ(before + 10, client_.estimates.size());

  // Set back by less than the tolerance: no restart, and no stamp twice.
  hold_clock_until(100.9, [] { return ros::Time::now() == ros::Time(100.9); });
  EXPECT_EQ(EventStatus::USED_LATE, [&] {
    const std::size_t statuses = client_.statuses.size();
    client_.publish_sample(ros::Time(100.3), 1.5);
    EXPECT_TRUE(hold_clock_until(100.9, [&] { return client_.statuses.size() > statuses; }));
    return client_.statuses.back().outcome;
  }());
  EXPECT_TRUE(hold_clock_until(101.4, [&] { return estimated_until(101.4); }));
  EXPECT_EQ(before + 20, client_.estimates.size());

  // Far ahead: what was missed follows, as far back as the history window of 20 s reaches.
  EXPECT_TRUE(hold_clock_until(1101.4, [&] { return estimated_until(1101.4); }));
  EXPECT_EQ(before + 20 + 1001, client_.estimates.size());
  for (const double value : client_.estimates.back().state) EXPECT_TRUE(std::isfinite(value));
  for (std::size_t i = 1; i < client_.estimates.size(); ++i) {
    EXPECT_LT(client_.estimates[i - 1].header.stamp, client_.estimates[i].header.stamp);
  }
  EXPECT_EQ(EventStatus::USED, sample_at(1101.5, 2.0).outcome);
}

/// A step back within the tolerance forgets no transform.
TEST_F(TimeJumpsTest, ACorrectedClockKeepsTheTransforms) {
  const ros::NodeHandle turning("turning");
  const ros::Publisher camera =
      ros::NodeHandle(turning).advertise<geometry_msgs::PointStamped>("camera", 10);
  const ros::Publisher tf = handle_.advertise<tf2_msgs::TFMessage>("/tf", 10);
  std::vector<EventStatus> statuses;
  const boost::function<void(const EventStatusConstPtr&)> take =
      [&](const EventStatusConstPtr& status) { statuses.push_back(*status); };
  const ros::Subscriber subscriber =
      ros::NodeHandle(turning).subscribe<EventStatus>("events", 100, take);
  ASSERT_TRUE(hold_clock_until(2000.0, [&] {
    return camera.getNumSubscribers() > 0 && tf.getNumSubscribers() > 0 &&
           subscriber.getNumPublishers() > 0 && ros::Time::now() == ros::Time(2000.0);
  }));
  geometry_msgs::PointStamped point;
  point.header.frame_id = "lens";
  point.point.x = 1.0;
  const auto measure = [&](double stamp) {
    point.header.stamp = ros::Time(stamp);
    camera.publish(point);
  };
  for (const double stamp : {1999.0, 2000.0}) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    message.transforms[0].header.stamp = ros::Time(stamp);
    message.transforms[0].header.frame_id = "map";
    message.transforms[0].child_frame_id = "turntable";
    message.transforms[0].transform.rotation.w = 1.0;
    tf.publish(message);
  }
  measure(1999.2);
  ASSERT_TRUE(hold_clock_until(2000.0, [&] { return !statuses.empty(); }));
  EXPECT_EQ(EventStatus::USED, statuses[0].outcome) << statuses[0].reason;

  ASSERT_TRUE(hold_clock_until(1999.9, [] { return ros::Time::now() == ros::Time(1999.9); }));
  ros::WallDuration(0.3).sleep();  // the observer, too, hears the clock
  measure(1999.4);
  if (!hold_clock_until(1999.9, [&] { return statuses.size() > 1; })) {
    hold_clock_until(2010.0, [&] { return statuses.size() > 1; });
  }
  ASSERT_EQ(2u, statuses.size());
  EXPECT_EQ(EventStatus::USED, statuses[1].outcome) << statuses[1].reason;
}

}  // namespace
}  // namespace sampled_data_observers
