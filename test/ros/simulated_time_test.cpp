// A clock that this test publishes: events before it, time that goes on, and time that goes back.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <rosgraph_msgs/Log.h>

#include "messages/time_conversion.h"
#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

class SimulatedTimeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    clock_publisher_ = handle_.advertise<rosgraph_msgs::Clock>("/clock", 10);
    ASSERT_TRUE(client_.connect());
    ASSERT_TRUE(test::spin_until([this] { return clock_publisher_.getNumSubscribers() >= 2; }));
  }

  void set_clock(double seconds) {
    rosgraph_msgs::Clock message;
    message.clock = ros::Time(seconds);
    clock_publisher_.publish(message);
  }

  /// Sets the clock again and again, as simulators do, until something holds.
  bool hold_clock_until(double seconds, const std::function<bool()>& done) {
    return test::spin_until([&] {
      set_clock(seconds);
      ros::WallDuration(0.01).sleep();
      return done();
    });
  }

  ros::NodeHandle handle_;
  ros::Publisher clock_publisher_;
  test::ObserverClient client_;
};

// First, while there is no time yet.
TEST_F(SimulatedTimeTest, WithoutClockTheLogAndTheServicesNameTheParameter) {
  const std::string advice = "rosparam set /use_sim_time false";
  bool is_warned = false;
  const boost::function<void(const rosgraph_msgs::LogConstPtr&)> take =
      [&](const rosgraph_msgs::LogConstPtr& entry) {
        is_warned |= entry->level == rosgraph_msgs::Log::WARN &&
                     entry->msg.find(advice) != std::string::npos;
      };
  const ros::Subscriber log = handle_.subscribe<rosgraph_msgs::Log>("/rosout", 100, take);
  EXPECT_NE(std::string::npos, client_.reset({}).message.find(advice));
  EXPECT_NE(std::string::npos, client_.get_estimate(ros::Time()).message.find(advice));
  // One in ten warnings is logged, every 30 s: the first may have come before this test listened.
  EXPECT_TRUE(test::spin_until([&] { return is_warned; }, 45.0));
}

TEST_F(SimulatedTimeTest, EventsWaitForTheClockAndEstimatesFollowItForthAndBack) {
  client_.publish_sample(ros::Time(100.0), 1.0);
  client_.publish_sample(ros::Time(5000.0), 1.0);
  EXPECT_FALSE(test::spin_until([&] { return !client_.statuses.empty(); }, 1.0));
  EXPECT_FALSE(client_.reset({}).success);
  ASSERT_TRUE(hold_clock_until(100.2, [&] { return client_.statuses.size() >= 2; }));
  EXPECT_EQ(EventStatus::USED, client_.statuses[0].outcome);
  EXPECT_EQ(EventStatus::IN_FUTURE, client_.statuses[1].outcome);

  ASSERT_TRUE(hold_clock_until(101.0, [&] {
    return !client_.estimates.empty() && client_.estimates.back().header.stamp == ros::Time(101.0);
  }));
  EXPECT_EQ(51u, client_.estimates.size());  // 100.00 s to 101.00 s at 50 Hz
  for (std::size_t i = 0; i < client_.estimates.size(); ++i) {
    EXPECT_EQ(100'000'000'000 + static_cast<Stamp>(i) * 20'000'000,
              to_stamp(client_.estimates[i].header.stamp));
  }

  // Back to 50 s: before the history window of 20 s.
  client_.publish_sample(ros::Time(50.0), 1.0);
  ASSERT_TRUE(hold_clock_until(50.1, [&] { return client_.statuses.size() >= 3; }));
  EXPECT_EQ(EventStatus::TOO_OLD, client_.statuses[2].outcome);
  EXPECT_EQ(51u, client_.estimates.size());

  const Reset::Response reset = client_.reset({2.0, 0.0});
  EXPECT_TRUE(reset.success) << reset.message;
  ASSERT_TRUE(hold_clock_until(51.0, [&] { return client_.estimates.size() > 90; }));
  EXPECT_EQ(ros::Time(50.1), client_.estimates[51].header.stamp);
  EXPECT_EQ(2.0, client_.estimates[51].state[0]);
  EXPECT_EQ(EventStatus::USED, client_.sample(ros::Time(50.5), {1.0}).outcome);
}

// 100,000 estimates a second are asked for, and no machine is so fast.
TEST_F(SimulatedTimeTest, EveryEventIsAnsweredWhereEstimatesCannotKeepUp) {
  constexpr std::uint32_t kQueue = 10000;
  std::size_t answered = 0;
  const boost::function<void(const EventStatus::ConstPtr&)> count =
      [&](const EventStatus::ConstPtr&) { ++answered; };
  const ros::Subscriber statuses = handle_.subscribe<EventStatus>("fast/events", kQueue, count);
  const ros::Publisher samples = handle_.advertise<Measurement>("fast/position", kQueue);
  ASSERT_TRUE(test::spin_until(
      [&] { return samples.getNumSubscribers() > 0 && statuses.getNumPublishers() > 0; }));
  double now = 1000.0;
  for (int i = 0; i < 3000; ++i, now += 0.1) {
    set_clock(now);
    for (const double stamp : {now - 0.05, now}) {
      samples.publish(test::ObserverClient::measurement(ros::Time(stamp), {1.0}));
    }
    ros::WallDuration(0.001).sleep();
    ros::spinOnce();
  }
  EXPECT_TRUE(test::spin_until([&] { return answered >= 6000; }, 60.0)) << answered;
  EXPECT_EQ(6000u, answered);
}

}  // namespace
}  // namespace sampled_data_observers
