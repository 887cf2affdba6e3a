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

TEST_P(EveryTypeTest, QueriesInPartsGiveTheSameBits) {
  std::mt19937_64 generator(4);
  const std::vector<OwnedEvent> events =
      test::random_events_for(*config_.law, generator, 40, kStart, 2 * kSecond);
  const auto estimator = make();
  for (const OwnedEvent& event : events) take(*estimator, event);
  Estimate expected = estimator->make_estimate();
  EstimateQuery query;
  std::uniform_int_distribution<Stamp> any(kStart - kSecond / 10, kStart + 4 * kSecond);
  std::uniform_int_distribution<std::int64_t> steps(1, 200);
  for (int i = 0; i < 60; ++i) {
    // The last ones lie beyond the horizon of those that are integrated.
    const Stamp stamp = any(generator) + (i < 55 ? 0 : 200 * kSecond);
    const Timeline::Query began = estimator->begin_query(stamp, stamp, query);
    const bool is_there = began == Timeline::Query::kOk;
    if (is_there) {
      while (!query.proceed(steps(generator))) estimator->approach(any(generator), 7);
    }
    const Timeline::Query found = estimator->estimate_at(stamp, expected);
    ASSERT_EQ(found == Timeline::Query::kOk || found == Timeline::Query::kHeld, is_there);
    if (!is_there) continue;
    const Eigen::VectorXd& state = query.estimate().state;
    EXPECT_TRUE(same_bits({state.data(), state.data() + state.size()},
                          {expected.state.data(), expected.state.data() + expected.state.size()}));
    EXPECT_EQ(expected.held, query.estimate().held);
    EXPECT_EQ(expected.counts.events, query.estimate().counts.events);
    EXPECT_EQ(stamp, query.estimate().stamp);
  }
}

/// Arrivals before, between and after changes of the law: no event before the change after which it
/// is stamped, else in any order.
class ChangingLaws {
 public:
  ChangingLaws(std::vector<Stamp> changes, const std::vector<OwnedEvent>& events,
               std::mt19937_64& generator)
      : changes_(std::move(changes)), arrivals_(changes_.size() + 1) {
    for (const OwnedEvent& event : events) {
      const auto first = static_cast<std::size_t>(std::count_if(
          changes_.begin(), changes_.end(), [&](Stamp change) { return change < event.stamp; }));
      // What the first estimate begins with is there in time.
      const bool begins = &event == &events.front();
      std::uniform_int_distribution<std::size_t> when(first, changes_.size());
      arrivals_[begins ? 0 : when(generator)].push_back(event);
    }
    for (std::vector<OwnedEvent>& batch : arrivals_) {
      std::shuffle(batch.begin(), batch.end(), generator);
    }
  }

  template <class Make, class Take>
  std::unique_ptr<Estimator> run(const Make& make, const Take& take) const {
    std::unique_ptr<Estimator> estimator = make();
    for (std::size_t i = 0; i < arrivals_.size(); ++i) {
      for (const OwnedEvent& event : arrivals_[i]) take(*estimator, event);
      if (i == changes_.size()) break;
      std::unique_ptr<Estimator> next = make();
      next->take_over(*estimator, changes_[i]);
      estimator = std::move(next);
    }
    return estimator;
  }

 private:
  std::vector<Stamp> changes_;
  std::vector<std::vector<OwnedEvent>> arrivals_;
};

TEST_P(EveryTypeTest, EveryOrderOfArrivalAroundOtherGainsGivesTheSameBits) {
  const std::vector<Stamp> changes = {kStart + kSecond / 2, kStart + kSecond,
                                      kStart + 3 * kSecond / 2};
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    std::mt19937_64 generator(seed);
    std::vector<OwnedEvent> events =
        test::random_events_for(*config_.law, generator, 40, kStart, 2 * kSecond);
    // A delayed jump is only taken in late where its release, 50 ms later, lies before the change.
    events.erase(
        std::remove_if(events.begin(), events.end(),
                       [&](const OwnedEvent& event) {
                         return std::any_of(changes.begin(), changes.end(), [&](Stamp change) {
                           return event.kind == EventKind::kJump && event.stamp <= change &&
                                  event.stamp > change - kSecond / 10;
                         });
                       }),
        events.end());
    std::sort(events.begin(), events.end(),
              [](const OwnedEvent& a, const OwnedEvent& b) { return a.stamp < b.stamp; });
    std::vector<double> expected;
    for (int order = 0; order < 8; ++order) {
      const ChangingLaws laws(changes, events, generator);
      const auto estimator = laws.run([&] { return make(); },
                                      [](Estimator& at, const OwnedEvent& event) {
                                        EXPECT_NE(EventOutcome::kTooOld, take(at, event).outcome);
                                      });
      EXPECT_EQ(events.front().stamp, *estimator->earliest());
      if (order == 0) expected = history(*estimator);
      EXPECT_TRUE(same_bits(expected, history(*estimator))) << "seed " << seed;
    }
  }
}

TEST_P(EveryTypeTest, NothingIsAllocatedForEventsOfBeforeOtherGains) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  std::mt19937_64 generator(3);
  const std::vector<OwnedEvent> events =
      test::random_events_for(*config_.law, generator, 100, kStart, 2 * kSecond);
  const auto first = make();
  take(*first, events.front());
  const auto second = make();
  second->take_over(*first, kStart + kSecond);
  const Estimate* estimate = nullptr;
  const std::size_t before = test::allocations();
  for (const OwnedEvent& event : events) {
    take(*second, event);
    second->estimate_at(event.stamp, estimate);
  }
  EXPECT_EQ(before, test::allocations());
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
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(config_.law->estimate_size(), 0.11, 0.29);
  config_.plant->normalize(x.data());
  estimator->restart(kStart + 2 * kSecond, x);
  Estimate estimate = estimator->make_estimate();
  ASSERT_EQ(Timeline::Query::kOk, estimator->estimate_at(kStart + 2 * kSecond, estimate));
  EXPECT_EQ(x, estimate.state.head(x.size()));
}

INSTANTIATE_TEST_SUITE_P(Types, EveryTypeTest, ::testing::ValuesIn(test::type_examples()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace sampled_data_observers
