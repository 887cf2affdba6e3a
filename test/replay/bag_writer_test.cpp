#include "replay/bag_writer.h"

#include <gtest/gtest.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <unistd.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "replay/bag_source.h"

namespace sampled_data_observers {
namespace {

/// As many as are more than what is held in memory.
constexpr int kMessages = 3000;

std_msgs::String text(int number) {
  std_msgs::String message;
  message.data = std::to_string(number) + std::string(static_cast<std::size_t>(number), '.');
  return message;
}

ros::Time time_of(int number) { return ros::Time(100 + number / 10, 0); }

class BagWriterTest : public ::testing::Test {
 protected:
  BagWriterTest() {
    std::string name = "/tmp/bag_writer_test_XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name);
    folder_ = name;
  }
  ~BagWriterTest() override { std::filesystem::remove_all(folder_); }

  std::string path() const { return folder_ + "/out.bag"; }

  std::string folder_;
};

TEST_F(BagWriterTest, WritesAllMessagesInTheOrderInWhichTheyCame) {
  const auto header = boost::make_shared<ros::M_string>(
      ros::M_string{{"callerid", "/talker"},
                    {"latching", "1"},
                    {"md5sum", ros::message_traits::md5sum<std_msgs::String>()},
                    {"message_definition", ros::message_traits::definition<std_msgs::String>()},
                    {"type", "std_msgs/String"}});
  {
    BagWriter writer(path());
    for (int i = 0; i < kMessages; ++i) {
      writer.write(i % 3 == 0 ? "/a" : "/b", time_of(i), text(i), i % 2 == 0 ? nullptr : header);
    }
    EXPECT_FALSE(std::filesystem::exists(path()));
    writer.finish();
  }
  rosbag::Bag bag;
  open_for_reading(bag, path());
  rosbag::View view(bag);
  ASSERT_EQ(kMessages, static_cast<int>(view.size()));
  std::vector<bool> found(kMessages, false);
  std::map<std::pair<std::string, std::size_t>, int> newest;
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<std_msgs::String>();
    ASSERT_NE(nullptr, message);
    const int i = std::stoi(message->data);
    EXPECT_EQ(text(i).data, message->data);
    EXPECT_EQ(time_of(i), instance.getTime());
    EXPECT_EQ(i % 3 == 0 ? "/a" : "/b", instance.getTopic());
    const std::size_t is_latched = instance.getConnectionHeader()->count("latching");
    EXPECT_EQ(i % 2 == 0 ? 0U : 1U, is_latched);
    int& before = newest.emplace(std::make_pair(instance.getTopic(), is_latched), -1).first->second;
    EXPECT_LT(before, i);
    before = i;
    found[static_cast<std::size_t>(i)] = true;
  }
  EXPECT_EQ(kMessages, std::count(found.begin(), found.end(), true));
}

TEST_F(BagWriterTest, AFaultOfTheThreadEndsTheCallerAndLeavesNothing) {
  BagWriter writer(path());
  writer.write("/a", time_of(0), text(1));
  const ros::Time none;  // which rosbag refuses
  writer.write("/a", none, text(1));
  try {
    for (int i = 0; i < 100 * kMessages; ++i) writer.write("/a", time_of(0), text(kMessages));
    FAIL() << "it went on";
  } catch (const ReplayError& fault) {
    EXPECT_EQ(0U, std::string(fault.what()).find(path() + ": can't be written: ")) << fault.what();
  }
  EXPECT_THROW(writer.finish(), ReplayError);
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(BagWriterTest, WhatIsNotFinishedIsNotThere) {
  {
    BagWriter writer(path());
    for (int i = 0; i < kMessages; ++i) writer.write("/a", time_of(i), text(i));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace sampled_data_observers
