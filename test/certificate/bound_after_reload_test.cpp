// What is rejected after gains were exchanged, of the time before: bounds of either law.
#include <gtest/gtest.h>

#include <cmath>

#include "certificate/certified_gains.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

constexpr char kReloadedGains[] = "test/certificate/ferrante2019_oscillator_0.2.yaml";
constexpr Stamp kReload = kStart + kSecond / 10;

class BoundAfterReloadTest : public ::testing::Test {
 protected:
  BoundAfterReloadTest() : before_(make(bounded_)) {
    before_.submit(OwnedEvent{kStart, EventKind::kSample, 0, {1.0}}.view(), kStart);
  }

  Estimator make(const ObserverConfig& config) const { return {config.law, bounded_.options}; }

  static bool has_bound(Estimator& estimator, Stamp stamp) {
    const Estimate* estimate = nullptr;
    EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(stamp, estimate));
    return std::isfinite(estimator.bound(*estimate, stamp + kSecond).value);
  }

  static void reject_jump(Estimator& estimator, Stamp stamp) {
    Event jump;
    jump.stamp = stamp;
    jump.kind = EventKind::kJump;
    estimator.note_rejected(jump, kReload + kSecond / 100);
  }

  const ObserverConfig bounded_ = CertifiedGains(kReloadedGains)
                                      .assuming("{initial_error: 1, noise: 0.1, disturbance: 0.5}")
                                      .config();
  const ObserverConfig unbounded_ = CertifiedGains(kReloadedGains).config();
  Estimator before_;
};

TEST_F(BoundAfterReloadTest, TheLawOfBeforeMindsEvenWhereTheNewOneDoesNot) {
  Estimator after = make(unbounded_);
  after.take_over(before_, kReload);
  const Stamp published_late = kReload - kSecond / 50;
  EXPECT_TRUE(has_bound(after, published_late));
  reject_jump(after, published_late - 1);
  EXPECT_FALSE(has_bound(after, published_late));
}

TEST_F(BoundAfterReloadTest, WhatTheLawOfBeforeCanNotMarkIsMarkedAfterIt) {
  before_.resume(kReload);
  Estimator after = make(bounded_);
  after.take_over(before_, kReload);
  EXPECT_TRUE(has_bound(after, kReload + kSecond / 100));
  reject_jump(after, kReload - kSecond / 50);
  EXPECT_FALSE(has_bound(after, kReload + kSecond / 100));
}

}  // namespace
}  // namespace sampled_data_observers::test
