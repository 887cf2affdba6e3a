#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "simulation/delivery.h"
#include "simulation/schedule.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;

TEST(RandomNumbersTest, StreamsDifferBySeedAndNameAndAreTheSameOtherwise) {
  const auto first = [](std::uint64_t seed, const std::string& name) {
    return RandomNumbers(seed, name).uniform(0.0, 1.0);
  };
  EXPECT_EQ(first(1, "a"), first(1, "a"));
  std::set<double> numbers;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (const char* name : {"a", "b", "ab", ""}) numbers.insert(first(seed, name));
  }
  EXPECT_EQ(400u, numbers.size());
}

TEST(RandomNumbersTest, GaussianNumbersHaveTheMomentsAndTailsOfTheNormalDistribution) {
  RandomNumbers random(1);
  constexpr int kSize = 400000;
  double sum = 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  int beyond_two = 0;
  int beyond_three = 0;
  for (int i = 0; i < kSize; ++i) {
    const double x = random.gaussian();
    sum += x;
    squares += x * x;
    fourths += x * x * x * x;
    beyond_two += std::abs(x) > 2.0 ? 1 : 0;
    beyond_three += std::abs(x) > 3.0 ? 1 : 0;
  }
  EXPECT_NEAR(0.0, sum / kSize, 5.0 / std::sqrt(kSize));
  EXPECT_NEAR(1.0, squares / kSize, 5.0 * std::sqrt(2.0 / kSize));
  EXPECT_NEAR(3.0, fourths / kSize, 5.0 * std::sqrt(96.0 / kSize));
  EXPECT_NEAR(0.0455003, static_cast<double>(beyond_two) / kSize, 0.0016);
  EXPECT_NEAR(0.0026998, static_cast<double>(beyond_three) / kSize, 0.0004);
}

TEST(RandomNumbersTest, ExponentialNumbersHaveTheTailsOfTheirDistribution) {
  RandomNumbers random(1);
  constexpr int kSize = 400000;
  double sum = 0.0;
  int beyond[4] = {};
  for (int i = 0; i < kSize; ++i) {
    const double x = random.exponential();
    sum += x;
    for (int j = 0; j < 4; ++j) beyond[j] += x > 0.5 + j ? 1 : 0;
  }
  EXPECT_NEAR(1.0, sum / kSize, 5.0 / std::sqrt(kSize));
  for (int j = 0; j < 4; ++j) {
    const double share = std::exp(-0.5 - j);
    EXPECT_NEAR(share, static_cast<double>(beyond[j]) / kSize, 5.0 * std::sqrt(share / kSize)) << j;
  }
}

TEST(ScheduleTest, UniformIntervalsFillTheirBoundsFromTheFirstOn) {
  Schedule schedule;
  schedule.T1 = kSecond / 5;
  schedule.T2 = 3 * kSecond;
  ScheduledTimes times(schedule, RandomNumbers(1));
  Duration last = 0;
  Duration shortest = kSecond;
  Duration longest = 0;
  double sum = 0.0;
  constexpr int kSize = 20000;
  for (int i = 0; i < kSize; ++i) {
    const Duration time = *times.next();
    shortest = std::min(shortest, time - last);
    longest = std::max(longest, time - last);
    sum += to_seconds(time - last);
    last = time;
  }
  EXPECT_GE(shortest, schedule.T1);
  EXPECT_LE(shortest, schedule.T1 + kSecond / 500);
  EXPECT_LE(longest, schedule.T2);
  EXPECT_GE(longest, schedule.T2 - kSecond / 500);
  EXPECT_NEAR(1.6, sum / kSize, 5.0 * 2.8 / std::sqrt(12.0 * kSize));
}

TEST(ScheduleTest, SineIsTheSequenceOfFerrante2019) {
  Schedule schedule;
  schedule.kind = Schedule::Kind::kSine;
  schedule.T1 = kSecond / 100;
  schedule.T2 = 2 * kSecond / 5;
  ScheduledTimes times(schedule, RandomNumbers(1));
  // (52): t_(j+1) - t_j = (T2 - T1)/2 sin(10 t_j) + (T2 + T1)/2
  Duration expected = schedule.T2;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(expected, times.next());
    expected += std::llround(
        1e9 * ((0.4 - 0.01) / 2.0 * std::sin(10.0 * to_seconds(expected)) + (0.4 + 0.01) / 2.0));
  }
}

TEST(ScheduleTest, PeriodsAndListsAreExact) {
  Schedule period;
  period.kind = Schedule::Kind::kPeriodic;
  period.T1 = 3;
  period.first = 1;
  ScheduledTimes periodic(period, RandomNumbers(1));
  EXPECT_EQ(1, periodic.next());
  EXPECT_EQ(4, periodic.next());
  EXPECT_EQ(7, periodic.next());
  Schedule list;
  list.kind = Schedule::Kind::kListed;
  list.times = {0, 5};
  ScheduledTimes listed(list, RandomNumbers(1));
  EXPECT_EQ(0, listed.next());
  EXPECT_EQ(5, listed.next());
  EXPECT_EQ(std::nullopt, listed.next());
}

TEST(DeliveryTest, ArrivesInOrderWithinTheBoundsOfTheLatency) {
  DeliveryLine line({10, 50, 0.0, 0.0, 0.0}, RandomNumbers(1));
  Stamp last = 0;
  Duration shortest = 1000;
  Duration longest = 0;
  for (Stamp stamp = 1; stamp < 20000; stamp += 5) {
    const std::vector<Stamp> arrivals = line.send(stamp);
    ASSERT_EQ(1u, arrivals.size());
    ASSERT_GE(arrivals[0], last);
    last = arrivals[0];
    shortest = std::min(shortest, arrivals[0] - stamp);
    longest = std::max(longest, arrivals[0] - stamp);
  }
  EXPECT_GE(shortest, 10);
  EXPECT_LE(shortest, 20);
  EXPECT_EQ(50, longest);
}

TEST(DeliveryTest, LosesDoublesAndReordersAtTheirRates) {
  constexpr int kSize = 50000;
  DeliveryLine line({0, 40, 0.1, 0.05, 0.2}, RandomNumbers(1));
  int lost = 0;
  int doubled = 0;
  int overtaken = 0;
  Stamp last = 0;
  for (int i = 0; i < kSize; ++i) {
    const std::vector<Stamp> arrivals = line.send(1 + 100 * i);
    lost += arrivals.empty() ? 1 : 0;
    doubled += arrivals.size() == 2 ? 1 : 0;
    if (arrivals.empty()) continue;
    overtaken += arrivals[0] - (1 + 100 * i) >= 40 ? 1 : 0;
    last = std::max(last, arrivals[0]);
  }
  EXPECT_NEAR(0.1, 1.0 * lost / kSize, 0.007);
  EXPECT_NEAR(0.05 * 0.9, 1.0 * doubled / kSize, 0.005);
  // Those in order have a latency of 40 once in 41 times.
  EXPECT_NEAR((0.2 + 0.8 / 41.0) * 0.9, 1.0 * overtaken / kSize, 0.01);
}

TEST(DeliveryTest, LaterMessagesOvertakeReorderedOnes) {
  DeliveryLine line({0, 40, 0.0, 0.0, 0.2}, RandomNumbers(1));
  std::vector<Stamp> arrivals;
  for (int i = 0; i < 10000; ++i) arrivals.push_back(line.send(1 + i).front());
  int overtaken = 0;
  for (std::size_t i = 0; i + 1 < arrivals.size(); ++i) {
    if (arrivals[i + 1] < arrivals[i]) ++overtaken;
  }
  EXPECT_NEAR(0.2 * 0.8, overtaken / 10000.0, 0.03);
}

}  // namespace
}  // namespace sampled_data_observers
