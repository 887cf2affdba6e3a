#include "sampled_data_observers/runtime/waiting_queue.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

constexpr Duration kTimeout = 100;

struct Outcome {
  std::vector<int> used;
  std::vector<int> dropped;
};

/// Goes through a queue of which the items below `ready` are usable.
Outcome go_through(WaitingQueue<int>& queue, Stamp now, int ready) {
  Outcome outcome;
  queue.go_through(
      now,
      [&](int item) {
        if (item < ready) outcome.used.push_back(item);
        return item < ready;
      },
      [&](int item) { outcome.dropped.push_back(item); });
  return outcome;
}

TEST(WaitingQueueTest, UsesEachItemOnceAsSoonAsItCan) {
  WaitingQueue<int> queue(8, kTimeout);
  for (const int item : {5, 1, 3}) EXPECT_TRUE(queue.push(item, 1000));
  EXPECT_EQ((std::vector<int>{1, 3}), go_through(queue, 1010, 4).used);
  EXPECT_FALSE(queue.empty());
  EXPECT_EQ((std::vector<int>{5}), go_through(queue, 1020, 9).used);
  EXPECT_TRUE(queue.empty());
  EXPECT_TRUE(go_through(queue, 1030, 9).used.empty());
}

TEST(WaitingQueueTest, DropsWhatWaitedLongerThanTheTimeout) {
  WaitingQueue<int> queue(8, kTimeout);
  queue.push(1, 1000);
  queue.push(2, 1050);
  EXPECT_TRUE(go_through(queue, 1100, 0).dropped.empty());
  EXPECT_EQ((std::vector<int>{1}), go_through(queue, 1101, 0).dropped);
  EXPECT_EQ((std::vector<int>{2}), go_through(queue, 5000, 0).dropped);
  EXPECT_TRUE(queue.empty());
}

TEST(WaitingQueueTest, WhatIsUsedDoesNotDependOnHowOftenItIsGoneThrough) {
  // Usable at 1101, when the first has timed out, whether anybody looked in between or not.
  for (const bool looks_in_between : {false, true}) {
    WaitingQueue<int> queue(8, kTimeout);
    queue.push(1, 1000);
    queue.push(2, 1001);
    if (looks_in_between) go_through(queue, 1100, 0);
    const Outcome outcome = go_through(queue, 1101, 9);
    EXPECT_EQ((std::vector<int>{2}), outcome.used);
    EXPECT_EQ((std::vector<int>{1}), outcome.dropped);
  }
}

TEST(WaitingQueueTest, TakesNoMoreThanItsCapacity) {
  WaitingQueue<int> queue(2, kTimeout);
  EXPECT_TRUE(queue.push(1, 1000));
  EXPECT_TRUE(queue.push(2, 1000));
  EXPECT_FALSE(queue.push(3, 1000));
  go_through(queue, 1000, 2);
  EXPECT_TRUE(queue.push(3, 1000));
  EXPECT_EQ((std::vector<int>{2, 3}), go_through(queue, 1000, 9).used);
}

TEST(WaitingQueueTest, NothingWaitsWithoutTime) {
  WaitingQueue<int> queue(8, 0);
  EXPECT_FALSE(queue.push(1, 1000));
  EXPECT_TRUE(queue.empty());
}

TEST(WaitingQueueTest, DropsAllWhenAsked) {
  WaitingQueue<int> queue(8, kTimeout);
  queue.push(1, 1000);
  queue.push(2, 1000);
  std::vector<int> dropped;
  queue.drop_all([&](int item) { dropped.push_back(item); });
  EXPECT_EQ((std::vector<int>{1, 2}), dropped);
  EXPECT_TRUE(queue.empty());
}

TEST(WaitingQueueTest, AllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  WaitingQueue<int> queue(8, kTimeout);
  const std::size_t before = test::allocations();
  for (int i = 0; i < 100; ++i) {
    queue.push(i, i);
    queue.go_through(
        i, [&](int item) { return item % 3 == i % 3; }, [](int) {});
  }
  EXPECT_EQ(before, test::allocations());
}

}  // namespace
}  // namespace sampled_data_observers
