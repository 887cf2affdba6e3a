#include "sampled_data_observers/real_time/deadline_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "real_time/steady_deadline.h"

namespace sampled_data_observers {
namespace {

using Clock = DeadlineThread::Clock;
using std::chrono::milliseconds;

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
    DeadlineThread thread(
        [&] {
          const int run = runs;
          if (Clock::now() < start + run * milliseconds(2)) ++early;
          runs = run + 1;
          return start + (run + 1) * milliseconds(2);
        },
        "test");
    wait_for([&] { return runs >= 100; });
  }
  EXPECT_EQ(0, early);
  // One run for each deadline that has passed, whatever held some of them up.
  EXPECT_LE(runs, (Clock::now() - start) / milliseconds(2) + 1);
}

TEST(DeadlineThreadTest, CatchesUpWithDeadlinesThatHavePassed) {
  const Clock::time_point start = Clock::now();
  std::atomic<int> runs{0};
  const DeadlineThread thread([&] { return ++runs < 1000 ? start : start + std::chrono::hours(1); },
                              "test");
  wait_for([&] { return runs == 1000; });
}

TEST(DeadlineThreadTest, WakesBeforeItsDeadlineWhenTold) {
  std::atomic<int> runs{0};
  DeadlineThread thread(
      [&] {
        ++runs;
        return Clock::now() + std::chrono::hours(1);
      },
      "test");
  wait_for([&] { return runs == 1; });
  thread.wake();
  wait_for([&] { return runs == 2; });
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(2, runs);
}

TEST(DeadlineThreadTest, DoesNotForgetToWakeAfterATaskDuringWhichItWasTold) {
  std::atomic<int> runs{0};
  std::atomic<bool> told{false};
  DeadlineThread thread(
      [&] {
        if (++runs == 1) {
          while (!told) std::this_thread::yield();
        }
        return Clock::now() + std::chrono::hours(1);
      },
      "test");
  wait_for([&] { return runs == 1; });
  thread.wake();
  told = true;
  wait_for([&] { return runs == 2; });
}

TEST(DeadlineThreadTest, StopsAtOnceHoweverFarItsDeadline) {
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < 50; ++i) {
    const DeadlineThread thread([] { return Clock::now() + std::chrono::hours(1); }, "test");
  }
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(10));
}

TEST(DeadlineThreadTest, SaysWhyAPriorityIsNotPossibleAndGoesOn) {
  std::atomic<int> runs{0};
  DeadlineThread thread(
      [&] {
        ++runs;
        return Clock::now() + milliseconds(1);
      },
      "test");
  EXPECT_NE("", thread.set_real_time_priority(1000));
  const int before = runs;
  wait_for([&] { return runs > before + 2; });
}

TEST(SteadyDeadlineTest, LiesAsFarAheadAsTheWaitButNoFurtherThanASecond) {
  const Clock::time_point now = Clock::now();
  EXPECT_EQ(now + milliseconds(5), steady_deadline(5'000'000, now));
  EXPECT_EQ(now + std::chrono::seconds(1), steady_deadline(3600 * kNanosecondsPerSecond, now));
}

}  // namespace
}  // namespace sampled_data_observers
