#include "replay/thinning.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sampled_data_observers {
namespace {

std::vector<Stamp> regular(std::size_t size, Duration period) {
  std::vector<Stamp> stamps;
  for (std::size_t i = 0; i < size; ++i) stamps.push_back(1000 + static_cast<Stamp>(i) * period);
  return stamps;
}

std::vector<Stamp> chosen(const std::vector<Stamp>& stamps, const std::vector<bool>& kept) {
  std::vector<Stamp> result;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (kept[i]) result.push_back(stamps[i]);
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(ThinningTest, IntervalsLieInTheBoundsAndFillThem) {
  const std::vector<Stamp> stamps = regular(20000, 8);
  const std::vector<Stamp> kept = chosen(stamps, thin(stamps, 50, 200, 1));
  EXPECT_EQ(stamps.front(), kept.front());
  Duration shortest = 1000;
  Duration longest = 0;
  for (std::size_t i = 1; i < kept.size(); ++i) {
    shortest = std::min(shortest, kept[i] - kept[i - 1]);
    longest = std::max(longest, kept[i] - kept[i - 1]);
  }
  EXPECT_GE(shortest, 50);
  EXPECT_LE(shortest, 56);
  EXPECT_LE(longest, 200);
  EXPECT_GE(longest, 192);
  const double mean =
      static_cast<double>(kept.back() - kept.front()) / static_cast<double>(kept.size() - 1);
  EXPECT_NEAR(125.0, mean, 5.0);
}

TEST(ThinningTest, TheSeedDecidesAndTheOrderOfArrivalDoesNot) {
  std::vector<Stamp> stamps = regular(1000, 8);
  const std::vector<Stamp> once = chosen(stamps, thin(stamps, 50, 200, 3));
  EXPECT_EQ(once, chosen(stamps, thin(stamps, 50, 200, 3)));
  EXPECT_NE(once, chosen(stamps, thin(stamps, 50, 200, 4)));
  std::reverse(stamps.begin(), stamps.end());
  EXPECT_EQ(once, chosen(stamps, thin(stamps, 50, 200, 3)));
}

TEST(ThinningTest, AGapIsFollowedByTheFirstSampleAfterIt) {
  const std::vector<Stamp> stamps = {0, 10, 500, 510};
  EXPECT_EQ((std::vector<bool>{true, false, true, false}), thin(stamps, 50, 100, 0));
  EXPECT_TRUE(thin({}, 50, 100, 0).empty());
}

TEST(ThinningTest, WhatIsNoSampleStays) {
  std::vector<std::optional<Stamp>> messages;
  std::vector<Stamp> samples;
  for (Stamp stamp = 1000; stamp < 2000; stamp += 10) {
    messages.emplace_back(stamp);
    messages.emplace_back(std::nullopt);
    samples.push_back(stamp);
  }
  const std::vector<bool> kept = thin_among(messages, 50, 90, 3);
  const std::vector<bool> expected = thin(samples, 50, 90, 3);
  ASSERT_EQ(messages.size(), kept.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(expected[i], kept[2 * i]);
    EXPECT_TRUE(kept[2 * i + 1]);
  }
}

}  // namespace
}  // namespace sampled_data_observers
