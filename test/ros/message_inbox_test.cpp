// Messages that come faster than they are used.
#include "sampled_data_observers/ros/message_inbox.h"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <string>
#include <vector>

#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

class Warnings : public ros::console::LogAppender {
 public:
  void log(ros::console::Level level, const char* text, const char*, const char*, int) override {
    if (level == ros::console::levels::Warn) texts.emplace_back(text);
  }
  std::vector<std::string> texts;
};

Warnings& warnings() {
  static auto& all = *new Warnings;  // rosconsole never lets it go
  static const bool once = (ros::console::register_appender(&all), true);
  static_cast<void>(once);
  all.texts.clear();
  return all;
}

using test::kSecond;

class MessageInboxTest : public testing::Test {
 protected:
  void push(std::size_t topic, Stamp stamp) { inbox_.push({topic, nullptr, stamp, stamp}); }

  ros::CallbackQueue queue_;
  std::vector<Stamp> used_;
  Warnings& warnings_ = warnings();
  MessageInbox inbox_{
      {"/signal", "/other"},
      2,
      queue_,
      NodeLog("/inbox"),
      [this](const MessageQueue::Message& message) { used_.push_back(message.stamp); }};
};

TEST_F(MessageInboxTest, TheyAreUsedInTheOrderOfTheirArrival) {
  push(1, 5 * kSecond);
  push(0, 3 * kSecond);
  push(1, 4 * kSecond);
  EXPECT_TRUE(used_.empty());
  while (!queue_.isEmpty()) queue_.callAvailable();
  EXPECT_EQ((std::vector<Stamp>{5 * kSecond, 3 * kSecond, 4 * kSecond}), used_);
  EXPECT_TRUE(warnings_.texts.empty());
}

TEST_F(MessageInboxTest, WhatWaitsCanBeUsedBeforeItsTurn) {
  push(0, 1 * kSecond);
  push(1, 2 * kSecond);
  push(0, 3 * kSecond);
  inbox_.use_waiting();
  EXPECT_EQ((std::vector<Stamp>{1 * kSecond, 2 * kSecond, 3 * kSecond}), used_);
  push(1, 4 * kSecond);
  while (!queue_.isEmpty()) queue_.callAvailable();
  EXPECT_EQ(4 * kSecond, used_.back());
  EXPECT_EQ(4u, used_.size());
}

TEST_F(MessageInboxTest, TheLogTellsOfThoseThatMakeRoom) {
  for (Stamp stamp = 1; stamp <= 7; ++stamp) push(0, stamp * kSecond);
  push(1, 9 * kSecond);
  while (!queue_.isEmpty()) queue_.callAvailable();
  EXPECT_EQ((std::vector<Stamp>{6 * kSecond, 7 * kSecond, 9 * kSecond}), used_);
  ASSERT_EQ(1u, warnings_.texts.size());  // of the others later
  EXPECT_EQ(
      "messages on /signal come faster than they are used: 1 dropped (up to stamp 1.000000000 s)",
      warnings_.texts[0]);
}

/// As a subscriber whose callback runs in another thread now.
class Busy : public ros::CallbackInterface {
 public:
  CallResult call() override { return ++calls < 3 ? TryAgain : Success; }
  int calls = 0;
};

TEST(AtOnceTest, WhatIsPutOffIsCalledAgain) {
  const auto busy = boost::make_shared<Busy>();
  AtOnce queue;
  queue.addCallback(busy, 0);
  EXPECT_EQ(3, busy->calls);
}

}  // namespace
}  // namespace sampled_data_observers
