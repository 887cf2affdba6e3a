#include "sampled_data_observers/runtime/median_recorder.h"

#include <gtest/gtest.h>

#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

TEST(MedianRecorderTest, GivesTheMedianOfWhatCameSinceTheLastCall) {
  MedianRecorder recorder;
  EXPECT_FALSE(recorder.take());
  for (const std::int64_t value : {5, -100, 7}) recorder.record(value);
  EXPECT_EQ(5, *recorder.take());
  EXPECT_FALSE(recorder.take());
  for (const std::int64_t value : {4, 1, 3, 2}) recorder.record(value);
  EXPECT_EQ(2, *recorder.take());
}

TEST(MedianRecorderTest, OfManyOnlyTheLastCountAndNothingIsAllocated) {
  MedianRecorder recorder;
  const std::size_t before = test::allocations();
  for (std::int64_t i = 0; i < 1000; ++i) recorder.record(i);
  EXPECT_EQ(1000 - 32, *recorder.take());
  EXPECT_EQ(before, test::allocations());
}

}  // namespace
}  // namespace sampled_data_observers
