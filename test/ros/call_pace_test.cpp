#include "sampled_data_observers/ros/call_pace.h"

#include <gtest/gtest.h>

namespace sampled_data_observers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(CallPaceTest, TenCallsInARowAreAnsweredAtOnceAndThenTwentyASecond) {
  CallPace pace;
  const CallPace::Clock::time_point now{seconds(1000)};
  for (int call = 0; call < 10; ++call) EXPECT_LE(pace.turn(now), now);
  for (int call = 1; call <= 40; ++call) {
    EXPECT_EQ(pace.turn(now), now + call * milliseconds(50));
  }
}

TEST(CallPaceTest, ACallEachFiftyMillisecondsNeverWaits) {
  CallPace pace;
  CallPace::Clock::time_point now{seconds(1000)};
  for (int call = 0; call < 1000; ++call, now += milliseconds(50)) EXPECT_LE(pace.turn(now), now);
}

TEST(CallPaceTest, AfterARestTheyAreAnsweredAtOnceAgain) {
  CallPace pace;
  CallPace::Clock::time_point now{seconds(1000)};
  for (int call = 0; call < 30; ++call) pace.turn(now);
  now += seconds(2);
  for (int call = 0; call < 10; ++call) EXPECT_LE(pace.turn(now), now);
  EXPECT_GT(pace.turn(now), now);
}

}  // namespace
}  // namespace sampled_data_observers
