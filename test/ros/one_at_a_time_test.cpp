#include "sampled_data_observers/ros/one_at_a_time.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>

namespace sampled_data_observers {
namespace {

using Clock = std::chrono::steady_clock;

TEST(OneAtATimeTest, OthersWaitForAWhileAndAreNotLetIn) {
  OneAtATime calls;
  const OneAtATime::Turn first = calls.enter();
  EXPECT_TRUE(first.owns_lock());
  const auto second = [&] {
    const Clock::time_point began = Clock::now();
    EXPECT_FALSE(calls.enter().owns_lock());
    return Clock::now() - began;
  };
  // What calls again and again is let through no more often than this.
  EXPECT_GE(std::async(std::launch::async, second).get(), std::chrono::milliseconds(19));
}

TEST(OneAtATimeTest, TheNextIsLetInAsSoonAsTheFirstIsOut) {
  OneAtATime calls;
  calls.enter();
  EXPECT_TRUE(std::async(std::launch::async, [&] { return calls.enter().owns_lock(); }).get());
}

}  // namespace
}  // namespace sampled_data_observers
