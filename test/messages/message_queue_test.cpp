// What waits between the threads that receive messages and the one that uses them.
#include "sampled_data_observers/messages/message_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <thread>

#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

MessageQueue::Message message(std::size_t channel, Stamp stamp) {
  return {channel, boost::make_shared<const int>(0), stamp + 1, stamp};
}

TEST(MessageQueueTest, GivesMessagesOfAllChannelsInTheOrderOfArrival) {
  MessageQueue queue(2, 3);
  EXPECT_TRUE(queue.push(message(1, 9)));
  EXPECT_FALSE(queue.push(message(0, 4)));  // somebody was asked already
  EXPECT_FALSE(queue.push(message(1, 5)));
  for (const Stamp expected : {9, 4, 5}) {
    const MessageQueue::Next next = queue.take();
    ASSERT_TRUE(next.message);
    EXPECT_EQ(expected, next.message->stamp);
    EXPECT_EQ(expected + 1, next.message->receipt);
    EXPECT_FALSE(next.drop);
    EXPECT_EQ(expected != 5, next.more);
  }
  EXPECT_FALSE(queue.take().message);
  EXPECT_TRUE(queue.push(message(0, 6)));
}

TEST(MessageQueueTest, TheOldestOfAFullChannelMakesRoomAndIsHandedOver) {
  MessageQueue queue(2, 2);
  queue.push(message(0, 50));
  for (Stamp stamp = 1; stamp <= 4; ++stamp) queue.push(message(1, stamp));
  MessageQueue::Next next = queue.take();
  EXPECT_EQ(50, next.message->stamp);
  EXPECT_EQ(1u, next.drop->channel);
  EXPECT_EQ(1, next.drop->first);
  EXPECT_EQ(1u, next.drop->count);
  next = queue.take();
  EXPECT_EQ(2, next.drop->first);
  EXPECT_EQ(3, next.message->stamp);
  next = queue.take();
  EXPECT_FALSE(next.drop);
  EXPECT_EQ(4, next.message->stamp);
  EXPECT_FALSE(next.more);
}

TEST(MessageQueueTest, ManyDropsAreJoinedAndNoneIsForgotten) {
  MessageQueue queue(1, 2);
  for (Stamp stamp = 1; stamp <= 10; ++stamp) queue.push(message(0, stamp));
  EXPECT_EQ(1u, queue.take().drop->count);
  const MessageQueue::Next next = queue.take();
  EXPECT_EQ(7u, next.drop->count);
  EXPECT_EQ(2, next.drop->first);
  EXPECT_EQ(8, next.drop->last);
}

TEST(MessageQueueTest, WhoCannotTakeIsAskedAgain) {
  MessageQueue queue(1, 2);
  EXPECT_TRUE(queue.push(message(0, 1)));
  queue.suspend();
  EXPECT_TRUE(queue.push(message(0, 2)));
  EXPECT_EQ(1, queue.take().message->stamp);
}

TEST(MessageQueueTest, AllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  MessageQueue queue(2, 3);
  const MessageQueue::Message first = message(0, 1);
  const MessageQueue::Message second = message(1, 2);
  const std::size_t before = test::allocations();
  for (int i = 0; i < 20; ++i) {
    queue.push(first);
    queue.push(second);
    if (i % 2 == 0) queue.take();
  }
  EXPECT_EQ(before, test::allocations());
}

TEST(MessageQueueTest, EveryMessageIsTakenOrDroppedWhoeverPushes) {
  constexpr int kMessages = 20000;
  MessageQueue queue(2, 50);
  std::atomic<int> running{2};
  std::atomic<int> asked{0};
  const auto push = [&](std::size_t channel) {
    for (int i = 0; i < kMessages; ++i) {
      if (queue.push(message(channel, i + 1))) ++asked;
    }
    --running;
  };
  std::thread one(push, 0);
  std::thread other(push, 1);
  std::uint64_t found = 0;
  while (running > 0 || asked > 0) {
    if (asked == 0) continue;
    --asked;
    while (true) {
      const MessageQueue::Next next = queue.take();
      if (next.message) ++found;
      if (next.drop) found += next.drop->count;
      if (!next.more) break;
    }
  }
  one.join();
  other.join();
  EXPECT_EQ(2u * kMessages, found);
}

}  // namespace
}  // namespace sampled_data_observers
