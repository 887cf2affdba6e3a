// The guaranteed bounds on each state, in messages.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "certificate/certified_gains.h"
#include "messages/runtime_messages.h"
#include "sampled_data_observers/messages/message_pool.h"
#include "support/allocation_counter.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class ErrorBoundsTest : public ::testing::Test {
 protected:
  static CertifiedGains gains() {
    return CertifiedGains("test/certificate/ferrante2019_oscillator_0.2.yaml")
        .assuming("{initial_error: 1, noise: 0.05, disturbance: 0.5}");
  }

  static void sample(ObserverRuntime& runtime, Stamp stamp) {
    const double y = 0.1;
    ASSERT_TRUE(runtime.receive({stamp, EventKind::kSample, 0, &y, 1}, stamp).used());
  }

  static StateEstimate message_at(ObserverRuntime& runtime, Stamp stamp) {
    std::string reason;
    const Estimate* estimate = runtime.estimate_at(stamp, reason);
    StateEstimate message;
    EXPECT_NE(nullptr, estimate) << reason;
    if (estimate != nullptr) write(runtime, *estimate, message);
    return message;
  }
};

TEST_F(ErrorBoundsTest, AreThereForEachStateAndCostNoAllocation) {
  const ObserverConfig config = gains().config();
  ObserverRuntime runtime(config);
  StateEstimate prototype;
  write(runtime, runtime.estimator().make_estimate(), prototype);
  ASSERT_EQ(2u, prototype.error_bounds.size());
  MessagePool<StateEstimate> estimates(prototype, 4);
  sample(runtime, kStart);
  std::size_t published = 0;
  const std::size_t before = allocations();
  for (int k = 1; k < 20; ++k) {
    const Stamp stamp = kStart + k * kSecond / 7;
    sample(runtime, stamp);
    while (const Estimate* estimate = runtime.next_due(stamp)) {
      const boost::shared_ptr<StateEstimate> message = estimates.take();
      write(runtime, *estimate, *message);
      ++published;
      ASSERT_TRUE(std::isfinite(message->error_bound));
      for (const double bound : message->error_bounds) {
        ASSERT_LE(bound, message->error_bound);
        ASSERT_GT(bound, 0.0);
      }
      // The axes of its ellipsoid are not those of the states.
      ASSERT_GT(std::hypot(message->error_bounds[0], message->error_bounds[1]),
                message->error_bound);
      ASSERT_LT(std::min(message->error_bounds[0], message->error_bounds[1]),
                0.99 * message->error_bound);
    }
  }
  EXPECT_TRUE(allocations() == before || !allocations_are_counted());
  EXPECT_GT(published, 100u);
}

TEST_F(ErrorBoundsTest, AreEmptyWithoutBoundAndInfiniteWhereThatOfTheNormIs) {
  ObserverRuntime unbounded(
      CertifiedGains("test/certificate/ferrante2019_oscillator_0.2.yaml").config());
  sample(unbounded, kStart);
  const StateEstimate without = message_at(unbounded, kStart);
  EXPECT_TRUE(std::isnan(without.error_bound));
  EXPECT_TRUE(without.error_bounds.empty());

  ObserverRuntime runtime(gains().config());
  sample(runtime, kStart);
  EXPECT_TRUE(std::isfinite(message_at(runtime, kStart + kSecond / 10).error_bounds[1]));
  const StateEstimate lost = message_at(runtime, kStart + 100'000 * kSecond);
  EXPECT_EQ(kInfinity, lost.error_bound);
  EXPECT_EQ(std::vector<double>(2, kInfinity), lost.error_bounds);
}

TEST_F(ErrorBoundsTest, OfAQueryAndAfterNewGainsAreThoseOfTheLawOfTheStamp) {
  ObserverRuntime runtime(gains().config());
  sample(runtime, kStart);
  sample(runtime, kStart + kSecond / 8);
  const Stamp stamp = kStart + kSecond / 6;
  const StateEstimate published = message_at(runtime, stamp);
  EstimateQuery query;
  ASSERT_EQ(nullptr, runtime.begin_query(stamp, stamp, query));
  ASSERT_TRUE(query.proceed(1'000'000'000));
  StateEstimate answer;
  write(query, "", answer);
  EXPECT_EQ(published.error_bounds, answer.error_bounds);

  ObserverRuntime next(gains().config());
  next.take_over(runtime, kStart + kSecond / 5);
  EXPECT_EQ(published.error_bounds, message_at(next, stamp).error_bounds);
  const StateEstimate after = message_at(next, kStart + kSecond / 4);
  EXPECT_TRUE(std::isfinite(after.error_bound));
  for (const double bound : after.error_bounds) EXPECT_LE(bound, after.error_bound);
}

}  // namespace
}  // namespace sampled_data_observers::test
