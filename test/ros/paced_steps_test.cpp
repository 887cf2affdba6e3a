#include "ros/paced_steps.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace sampled_data_observers {
namespace {

void compute_for(Duration cpu_time) {
  const Duration end = thread_cpu_time() + cpu_time;
  while (thread_cpu_time() < end) {
  }
}

TEST(PacedStepsTest, AThreadThatOthersKeepFromItsProcessorDoesNotDoLess) {
  PacedSteps pace(100);
  pace.begin();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  pace.end();
  EXPECT_GE(pace.steps(), 100);
}

TEST(PacedStepsTest, WhatTakesLongIsDoneInSmallerParts) {
  PacedSteps pace(3);
  for (const std::int64_t expected : {1, 1}) {  // at least one
    pace.begin();
    compute_for(100'000);
    pace.end();
    EXPECT_EQ(pace.steps(), expected);
  }
}

}  // namespace
}  // namespace sampled_data_observers
