// What must hold for every observer type: queries change nothing, the event path allocates nothing,
// and what is huge does no lasting harm.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "support/allocation_counter.h"
#include "support/stamps.h"
#include "support/type_examples.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

class EveryTypeTest : public ::testing::TestWithParam<std::string> {
 protected:
  EveryTypeTest() : config_(test::read_example(GetParam())) {
    config_.options.history = {100 * kSecond, 500};
  }

  std::unique_ptr<Estimator> make() const {
    return std::make_unique<Estimator>(config_.law, config_.options);
  }

  /// Takes in an event as if it were received long after all others.
  static EventReport take(Estimator& estimator, const OwnedEvent& event) {
    Event view = event.view();
    if (event.kind == EventKind::kJump) view.release = event.stamp + kSecond / 20;
    return estimator.submit(view, kStart + 50 * kSecond);
  }

  /// The states at many stamps, in order, and with them what they rest on.
  std::vector<double> history(const Estimator& estimator) const {
    std::vector<double> result;
    Estimate estimate = estimator.make_estimate();
    for (Stamp stamp = kStart - kSecond / 10; stamp < kStart + 3 * kSecond; stamp += 57'000'123) {
      const Timeline::Query query = estimator.estimate_at(stamp, estimate);
      result.push_back(static_cast<double>(query));
      if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) continue;
      result.insert(result.end(), estimate.state.data(),
                    estimate.state.data() + estimate.state.size());
      result.push_back(static_cast<double>(estimate.counts.events));
      result.push_back(static_cast<double>(estimate.counts.jumps));
    }
    return result;
  }

  static bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  }

  ObserverConfig config_;
};

TEST_P(EveryTypeTest, QueriesChangeNothing) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    std::mt19937_64 generator(seed);
    const std::vector<OwnedEvent> events =
        test::random_events_for(*config_.law, generator, 40, kStart, 2 * kSecond);
    std::uniform_int_distribution<Stamp> any(kStart - kSecond, kStart + 4 * kSecond);
    const auto quiet = make();
    const auto asked = make();
    Estimate estimate = asked->make_estimate();
    for (const OwnedEvent& event : events) {
      take(*quiet, event);
      take(*asked, event);
      for (int i = 0; i < 5; ++i) asked->estimate_at(any(generator), estimate);
    }
    EXPECT_TRUE(same_bits(history(*quiet), history(*asked))) << "seed " << seed;
  }
}

TEST_P(EveryTypeTest, NothingIsAllocatedForEventsAndQueries) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  std::mt19937_64 generator(3);
  const std::vector<OwnedEvent> events =
      test::random_events_for(*config_.law, generator, 300, kStart, 5 * kSecond);
  const auto estimator = make();
  Estimate estimate = estimator->make_estimate();
  const std::size_t before = test::allocations();
  for (const OwnedEvent& event : events) {
    take(*estimator, event);
    estimator->estimate_at(event.stamp + kSecond / 7, estimate);
  }
  estimator->restart(kStart + 6 * kSecond);
  EXPECT_EQ(before, test::allocations());
}

TEST_P(EveryTypeTest, TheEstimateStaysFiniteWhateverComes) {
  std::mt19937_64 generator(5);
  std::vector<OwnedEvent> events =
      test::random_events_for(*config_.law, generator, 200, kStart, 3 * kSecond);
  const auto estimator = make();
  std::uniform_int_distribution<int> tenth(0, 9);
  for (OwnedEvent& event : events) {
    const bool spoil = tenth(generator) < 3 && event.kind != EventKind::kJump;
    if (spoil && !event.values.empty()) event.values[0] = tenth(generator) < 5 ? 1e99 : -1e60;
    take(*estimator, event);
  }
  Estimate estimate = estimator->make_estimate();
  for (Stamp stamp = kStart + kSecond; stamp < kStart + 40 * kSecond; stamp += kSecond / 3) {
    ASSERT_NE(Timeline::Query::kNoEvent, estimator->estimate_at(stamp, estimate));
    EXPECT_TRUE(estimate.state.head(config_.law->estimate_size()).allFinite());
  }
}

TEST_P(EveryTypeTest, StartsAgainFromAGivenEstimate) {
  const auto estimator = make();
  std::mt19937_64 generator(6);
  for (const OwnedEvent& event :
       test::random_events_for(*config_.law, generator, 20, kStart, kSecond)) {
    take(*estimator, event);
  }
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(config_.law->estimate_size(), 0.11, 0.29);
  estimator->restart(kStart + 2 * kSecond, x);
  Estimate estimate = estimator->make_estimate();
  ASSERT_EQ(Timeline::Query::kOk, estimator->estimate_at(kStart + 2 * kSecond, estimate));
  EXPECT_EQ(x, estimate.state.head(x.size()));
}

INSTANTIATE_TEST_SUITE_P(Types, EveryTypeTest, ::testing::ValuesIn(test::type_examples()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace sampled_data_observers
