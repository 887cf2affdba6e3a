#include "sampled_data_observers/runtime/running_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

namespace sampled_data_observers {
namespace {

TEST(RunningScaleTest, IsThatOfTheLastValues) {
  for (const std::size_t size : {1u, 2u, 3u, 20u, 51u}) {
    RunningScale scale(size);
    std::deque<double> last;
    std::mt19937_64 generator(size);
    std::uniform_int_distribution<int> number(-5, 5);  // with many equal ones
    for (int i = 0; i < 500; ++i) {
      EXPECT_EQ(last.size() == size, scale.is_full());
      last.push_back(number(generator));
      scale.add(last.back());
      if (last.size() > size) last.pop_front();
      if (!scale.is_full()) continue;
      std::vector<double> sorted(last.begin(), last.end());
      std::sort(sorted.begin(), sorted.end());
      const double median = sorted[size / 2];
      ASSERT_EQ(median, scale.median());
      for (double& value : sorted) value = std::abs(value - median);
      std::sort(sorted.begin(), sorted.end());
      ASSERT_DOUBLE_EQ(1.4826 * sorted[size / 2], scale.deviation());
    }
  }
}

TEST(RunningScaleTest, IsTheStandardDeviationOfNormalValuesAndOutliersHardlyMoveIt) {
  RunningScale scale(5000);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal(3.0, 0.5);
  for (int i = 0; i < 5000; ++i) scale.add(i % 10 == 0 ? 1e6 : normal(generator));
  EXPECT_NEAR(3.0, scale.median(), 0.1);
  EXPECT_NEAR(0.5, scale.deviation(), 0.1);
  scale.clear();
  EXPECT_FALSE(scale.is_full());
}

}  // namespace
}  // namespace sampled_data_observers
