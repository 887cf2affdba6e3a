// The node twin as launched: stamps of its estimates, and its services.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <string>

#include "messages/time_conversion.h"
#include "ros/observer_client.h"

namespace sampled_data_observers {
namespace {

constexpr Duration kPeriod = 25'000'000;  // the launch file asks for 40 Hz, the file for 50 Hz

class InterfaceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(client_.connect());
    ASSERT_TRUE(client_.reset({}).success);
    ros::spinOnce();
    client_.estimates.clear();
  }

  test::ObserverClient client_;
};

TEST_F(InterfaceTest, EstimatesAreOnTheGridWithoutGapsAndStrictlyIncreasing) {
  client_.sample(ros::Time::now(), {1.0});
  const std::size_t before = client_.estimates.size();
  ASSERT_TRUE(test::spin_until([&] { return client_.estimates.size() >= before + 60; }));
  for (std::size_t i = 0; i < client_.estimates.size(); ++i) {
    const Stamp stamp = to_stamp(client_.estimates[i].header.stamp);
    EXPECT_EQ(0, stamp % kPeriod);
    if (i > 0) {
      EXPECT_EQ(kPeriod, stamp - to_stamp(client_.estimates[i - 1].header.stamp));
    }
    EXPECT_EQ("world", client_.estimates[i].header.frame_id);
    EXPECT_EQ((std::vector<std::string>{"p", "v"}), client_.estimates[i].names);
  }
  EXPECT_EQ(1u, client_.estimates.back().events);
  EXPECT_EQ(1u, client_.estimates.back().samples);
}

TEST_F(InterfaceTest, EstimatesAreThereAtOnceAfterAReset) {
  const std::size_t before = client_.estimates.size();
  ASSERT_TRUE(test::spin_until([&] { return client_.estimates.size() > before + 2; }));
  EXPECT_EQ(0u, client_.estimates.back().events);
}

TEST_F(InterfaceTest, ResetTakesAGivenStateAndForgetsEvents) {
  const ros::Time before = ros::Time::now();
  client_.sample(before, {1.0});
  EXPECT_FALSE(client_.reset({1.0}).success);
  EXPECT_NE("", client_.reset({1.0}).message);
  ASSERT_TRUE(client_.reset({4.0, 0.0}).success);
  EXPECT_EQ(EventStatus::TOO_OLD, client_.sample(before, {1.0}).outcome);
  const GetEstimate::Response now = client_.get_estimate(ros::Time());
  ASSERT_TRUE(now.success) << now.message;
  EXPECT_EQ(0u, now.estimate.events);
  EXPECT_NEAR(4.0, now.estimate.state[0], 1e-12);
}

TEST_F(InterfaceTest, GetEstimateSaysWhyThereIsNone) {
  const GetEstimate::Response none = client_.get_estimate(ros::Time(1.0));
  EXPECT_FALSE(none.success);
  EXPECT_NE(std::string::npos, none.message.find("before the first event"));
}

}  // namespace
}  // namespace sampled_data_observers
