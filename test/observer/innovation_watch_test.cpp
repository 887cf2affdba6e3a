#include "sampled_data_observers/observer/innovation_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sampled_data_observers {
namespace {

TEST(InnovationWatchTest, AnEstimateThatRunsAwayGrowsAndThenDiverges) {
  for (const double factor : {1.02, 1.1, 2.0, 1e3}) {
    SCOPED_TRACE(factor);
    InnovationWatch watch;
    double innovation = 0.01;
    double grew_at = 0.0;
    double diverged_at = 0.0;
    for (int i = 0; i < 2000 && diverged_at == 0.0; ++i) {
      innovation = std::min(1e200, innovation * factor);
      const InnovationTrend trend = watch.add(innovation, 1.0);
      if (trend == InnovationTrend::kGrowing && grew_at == 0.0) grew_at = innovation;
      if (trend == InnovationTrend::kDiverging) diverged_at = innovation;
    }
    EXPECT_GT(grew_at, 3.0);
    EXPECT_GT(diverged_at, grew_at);
    if (factor < 2.0) {
      EXPECT_LT(grew_at, 20.0);
      EXPECT_LT(diverged_at, 100.0);
    }
  }
}

TEST(InnovationWatchTest, ItIsSteadyAgainOnceTheInnovationsAreSmall) {
  InnovationWatch watch;
  for (double innovation = 0.01; innovation < 1e4; innovation *= 1.2) watch.add(innovation, 1.0);
  EXPECT_EQ(InnovationTrend::kDiverging, watch.trend());
  for (int i = 0; i < InnovationWatch::kWindow * 2; ++i) watch.add(0.1, 1.0);
  EXPECT_EQ(InnovationTrend::kSteady, watch.trend());
}

TEST(InnovationWatchTest, WhatIsLargeBecauseThePlantIsSaysNothing) {
  InnovationWatch watch;
  for (double size = 0.01; size < 1e10; size *= 1.2) {
    EXPECT_EQ(InnovationTrend::kSteady, watch.add(size, size));
  }
}

TEST(InnovationWatchTest, NoiseAndOutliersAndABadStartAreNoDivergence) {
  std::mt19937_64 random(1);
  const auto noise = [&random] { return std::abs(std::ldexp(static_cast<double>(random()), -64)); };
  InnovationWatch watch;
  // From far off, at rest.
  for (double error = 1e6; error > 1e-3; error *= 0.9) {
    ASSERT_EQ(InnovationTrend::kSteady, watch.add(error, 0.01));
  }
  for (int i = 0; i < 100000; ++i) {
    const bool is_outlier = i % 1000 == 0;
    const double value = is_outlier ? 1e6 : noise();
    ASSERT_EQ(InnovationTrend::kSteady, watch.add(value, is_outlier ? 1e6 : 0.3 * noise()));
  }
}

}  // namespace
}  // namespace sampled_data_observers
