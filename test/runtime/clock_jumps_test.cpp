#include "sampled_data_observers/runtime/clock_jumps.h"

#include <gtest/gtest.h>

namespace sampled_data_observers {
namespace {

TEST(ClockJumpsTest, TellsWhenTimeWentBackByMoreThanATolerance) {
  ClockJumps clock(10);
  EXPECT_EQ(0, clock.note(100));
  EXPECT_EQ(0, clock.note(90));
  EXPECT_EQ(0, clock.note(95));
  EXPECT_EQ(11, clock.note(89));  // than the latest, in small steps too
  EXPECT_EQ(0, clock.note(80));
  EXPECT_EQ(0, clock.note(100));
  EXPECT_EQ(100, clock.note(0));
  EXPECT_EQ(0, clock.note(1));
}

}  // namespace
}  // namespace sampled_data_observers
