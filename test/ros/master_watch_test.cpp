#include "sampled_data_observers/ros/master_watch.h"

#include <gtest/gtest.h>

namespace sampled_data_observers {
namespace {

const std::string kOdometry = "nav_msgs/Odometry";

TEST(MasterWatchTest, OfATopicThatNobodyPublishesThoseOfItsTypeAreNamed) {
  const std::vector<std::pair<std::string, std::string>> published = {
      {"/odometry", kOdometry}, {"/base/odom", kOdometry}, {"/imu", "sensor_msgs/Imu"}};
  EXPECT_EQ(
      "nobody publishes /odmetry; of its type, nav_msgs/Odometry, there are: /base/odom, "
      "/odometry; "
      "is it a misspelling of /odometry?",
      describe_silent_topic({"/odmetry", kOdometry}, published, {}));
  EXPECT_EQ(
      "nobody publishes /wheels; of its type, nav_msgs/Odometry, there are: /base/odom, /odometry",
      describe_silent_topic({"/wheels", kOdometry}, published, {}));
  EXPECT_EQ("", describe_silent_topic({"/scan", "sensor_msgs/LaserScan"}, published, {}));
  EXPECT_EQ("", describe_silent_topic({"/imu", "sensor_msgs/Imu"}, published, {}));
}

TEST(MasterWatchTest, WhatTheNodePublishesItselfIsNoneOfThem) {
  EXPECT_EQ("nobody publishes /odom; of its type, nav_msgs/Odometry, there are: /base/odom",
            describe_silent_topic({"/odom", kOdometry},
                                  {{"/odometry", kOdometry}, {"/base/odom", kOdometry}},
                                  {"/estimate", "/odometry"}));
}

TEST(MasterWatchTest, OfManyAFewAreNamed) {
  std::vector<std::pair<std::string, std::string>> published;
  for (char c = 'a'; c < 'a' + 12; ++c) published.emplace_back(std::string("/") + c, kOdometry);
  const std::string text = describe_silent_topic({"/odom", kOdometry}, published, {});
  EXPECT_NE(std::string::npos, text.find("/i, /j and 2 more")) << text;
}

}  // namespace
}  // namespace sampled_data_observers
