#include "sampled_data_observers/real_time/deadline_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <vector>

#include "real_time/steady_deadline.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

using Clock = DeadlineThread::Clock;
using std::chrono::milliseconds;

std::shared_ptr<DeadlineThread> make_thread() { return std::make_shared<DeadlineThread>("test"); }

void wait_for(const std::function<bool()>& done) {
  const Clock::time_point end = Clock::now() + std::chrono::seconds(20);
  while (!done() && Clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_TRUE(done());
}

TEST(DeadlineThreadTest, RunsAtAbsoluteDeadlinesWithoutMissingOrDrifting) {
  const Clock::time_point start = Clock::now();
  std::atomic<int> runs{0};
  std::atomic<int> early{0};
  {
    const DeadlineTask task(make_thread(), [&] {
      const int run = runs;
      if (Clock::now() < start + run * milliseconds(2)) ++early;
      runs = run + 1;
      return start + (run + 1) * milliseconds(2);
    });
    wait_for([&] { return runs >= 100; });
  }
  EXPECT_EQ(0, early);
  // One run for each deadline that has passed, whatever held some of them up.
  EXPECT_LE(runs, (Clock::now() - start) / milliseconds(2) + 1);
}

TEST(DeadlineThreadTest, CatchesUpWithDeadlinesThatHavePassed) {
  const Clock::time_point start = Clock::now();
  std::atomic<int> runs{0};
  const DeadlineTask task(make_thread(),
                          [&] { return ++runs < 1000 ? start : start + std::chrono::hours(1); });
  wait_for([&] { return runs == 1000; });
}

TEST(DeadlineThreadTest, WakesBeforeItsDeadlineWhenTold) {
  std::atomic<int> runs{0};
  DeadlineTask task(make_thread(), [&] {
    ++runs;
    return Clock::now() + std::chrono::hours(1);
  });
  wait_for([&] { return runs == 1; });
  task.wake();
  wait_for([&] { return runs == 2; });
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(2, runs);
}

TEST(DeadlineThreadTest, DoesNotForgetToWakeAfterATaskDuringWhichItWasTold) {
  std::atomic<int> runs{0};
  std::atomic<bool> told{false};
  DeadlineTask task(make_thread(), [&] {
    if (++runs == 1) {
      while (!told) std::this_thread::yield();
    }
    return Clock::now() + std::chrono::hours(1);
  });
  wait_for([&] { return runs == 1; });
  task.wake();
  told = true;
  wait_for([&] { return runs == 2; });
}

TEST(DeadlineThreadTest, StopsAtOnceHoweverFarItsDeadline) {
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < 50; ++i) {
    const DeadlineTask task(make_thread(), [] { return Clock::now() + std::chrono::hours(1); });
  }
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(10));
}

TEST(DeadlineThreadTest, SaysWhyAPriorityIsNotPossibleAndGoesOn) {
  std::atomic<int> runs{0};
  const std::shared_ptr<DeadlineThread> thread = make_thread();
  const DeadlineTask task(thread, [&] {
    ++runs;
    return Clock::now() + milliseconds(1);
  });
  EXPECT_NE("", thread->set_real_time_priority(1000));
  const int before = runs;
  wait_for([&] { return runs > before + 2; });
}

TEST(DeadlineThreadTest, IsOneForAllOfOnePriorityAndGoesWithTheLast) {
  const std::shared_ptr<DeadlineThread> first = DeadlineThread::shared("test", {});
  EXPECT_EQ(first, DeadlineThread::shared("test", {}));
  std::shared_ptr<DeadlineThread> urgent = DeadlineThread::shared("test", 5);
  EXPECT_NE(first, urgent);
  const std::weak_ptr<DeadlineThread> last = urgent;
  urgent.reset();
  EXPECT_TRUE(last.expired());
  EXPECT_NE(nullptr, DeadlineThread::shared("test", 5));
}

TEST(DeadlineTaskTest, WhatIsLateTakesTurnsWithTheOthersThatAreDue) {
  const std::shared_ptr<DeadlineThread> thread = make_thread();
  std::atomic<int> late{0};
  std::atomic<int> punctual{0};
  const DeadlineTask never_done(thread, [&] {
    ++late;
    return Clock::time_point();
  });
  const DeadlineTask often(thread, [&] {
    ++punctual;
    return Clock::now();
  });
  wait_for([&] { return punctual >= 1000; });
  EXPECT_GE(late, 999 - 1);  // and the other way round
}

TEST(DeadlineTaskTest, TheMostOverdueIsDoneFirst) {
  const std::shared_ptr<DeadlineThread> thread = make_thread();
  std::vector<int> order;
  std::atomic<bool> ready{false};
  std::atomic<int> done{0};
  const Clock::time_point far = Clock::now() + std::chrono::hours(1);
  const auto due = [&](int number, milliseconds delay) {
    return [&order, &done, far, number, delay, first = true]() mutable {
      const Clock::time_point next = first ? Clock::now() + delay : far;
      if (!first) {
        order.push_back(number);
        ++done;
      }
      first = false;
      return next;
    };
  };
  const DeadlineTask last(thread, due(3, milliseconds(60)));
  const DeadlineTask middle(thread, due(2, milliseconds(40)));
  const DeadlineTask soonest(thread, due(1, milliseconds(20)));
  const DeadlineTask holds_up(thread, [&, first = true]() mutable {
    if (first) std::this_thread::sleep_for(milliseconds(200));
    first = false;
    return far;
  });
  wait_for([&] { return done == 3; });
  EXPECT_EQ((std::vector<int>{1, 2, 3}), order);
}

TEST(DeadlineTaskTest, ItsTurnsAllocateNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP();
  const std::shared_ptr<DeadlineThread> thread = make_thread();
  std::atomic<std::size_t> before{0};
  std::atomic<std::size_t> after{0};
  std::atomic<int> runs{0};
  const DeadlineTask other(thread, [] { return Clock::now() + std::chrono::microseconds(50); });
  const DeadlineTask task(thread, [&] {
    if (runs == 10) before = test::allocations();
    if (runs == 1000) after = test::allocations();
    ++runs;
    return Clock::now();
  });
  while (runs <= 1000) std::this_thread::yield();
  EXPECT_EQ(before, after);
}

TEST(DeadlineTaskTest, GoesWithoutTheOthersAndOnlyWhenItHasEnded) {
  const std::shared_ptr<DeadlineThread> thread = make_thread();
  std::atomic<int> runs{0};
  const DeadlineTask stays(thread, [&] {
    ++runs;
    return Clock::now();
  });
  for (int i = 0; i < 200; ++i) {
    std::atomic<int> inside{0};
    {
      DeadlineTask goes(thread, [&] {
        ++inside;
        std::this_thread::yield();
        --inside;
        return Clock::now() + std::chrono::microseconds(i % 7);
      });
      goes.wake();
      while (i % 2 == 0 && inside == 0) std::this_thread::yield();
    }
    ASSERT_EQ(0, inside);
  }
  const int before = runs;
  wait_for([&] { return runs > before; });
}

TEST(SteadyDeadlineTest, LiesAsFarAheadAsTheWaitButNoFurtherThanASecond) {
  const Clock::time_point now = Clock::now();
  EXPECT_EQ(now + milliseconds(5), steady_deadline(5'000'000, now));
  EXPECT_EQ(now + std::chrono::seconds(1), steady_deadline(3600 * kNanosecondsPerSecond, now));
}

}  // namespace
}  // namespace sampled_data_observers
