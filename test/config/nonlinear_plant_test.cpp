// What a plant that is not linear does where its formulas have no value, and over long flows.
#include <gtest/gtest.h>

#include <cmath>

#include "sampled_data_observers/runtime/estimator.h"
#include "support/config_faults.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;

/// A tank that empties, by Torricelli's law: its root has no value below zero.
const char kTank[] = R"yaml(
observer: ConstantGainObserver
plant:
  states: [level]
  flow: {level: "-2*sqrt(level - 0.01)"}
  integration: {step: 0.01, horizon: 5}
sensors: {gauge: {h: ["ln(level)"], source: {topic: gauge}}}
sampling: {T1: 0.1, T2: 10}
gains: {L: [[0.5]]}
initial_estimate: {level: 1}
history: {duration: 100}
)yaml";

class TankTest : public ::testing::Test {
 protected:
  EventOutcome sample(double seconds, double y) {
    const Stamp stamp = kStart + from_seconds(seconds);
    return estimator_.submit({stamp, EventKind::kSample, 0, &y, 1, 0}, stamp).outcome;
  }
  Timeline::Query estimate(double seconds) {
    return estimator_.estimate_at(kStart + from_seconds(seconds), estimate_);
  }

  ObserverConfig config_ = test::parse(kTank);
  Estimator estimator_{config_.law, config_.options};
  Estimate estimate_ = estimator_.make_estimate();
};

TEST_F(TankTest, AFlowWithoutValueHoldsTheLastEstimateUntilASampleMendsIt) {
  ASSERT_EQ(EventOutcome::kUsed, sample(0.0, 0.0));
  ASSERT_EQ(Timeline::Query::kOk, estimate(0.2));
  EXPECT_LT(estimate_.state(0), 0.75);
  EXPECT_EQ(Timeline::Query::kHeld, estimate(2.0));  // empty after about 1 s
  EXPECT_TRUE(estimate_.held);
  EXPECT_EQ(1.0, estimate_.state(0));
  EXPECT_EQ(EventOutcome::kUsed, sample(2.0, std::log(0.5)));
  EXPECT_EQ(Timeline::Query::kHeld, estimate(2.0));  // nothing was flowed from it yet
  EXPECT_NEAR(1.0 + 0.5 * std::log(0.5), estimate_.state(0), 1e-15);
  EXPECT_EQ(Timeline::Query::kOk, estimate(2.001));
  EXPECT_FALSE(estimate_.held);
}

TEST_F(TankTest, ASampleWhoseOutputHasNoValueHasNoEffectAndIsReported) {
  ASSERT_EQ(EventOutcome::kUsed, sample(0.0, -2.5));  // the estimate is now -0.25
  ASSERT_EQ(Timeline::Query::kOk, estimate(0.0));
  EXPECT_EQ(-0.25, estimate_.state(0));
  EXPECT_EQ(EventOutcome::kWouldOverflow, sample(0.1, 0.0));  // ln(-0.25)
  EXPECT_EQ(Timeline::Query::kHeld, estimate(0.2));
  EXPECT_EQ(-0.25, estimate_.state(0));
}

TEST_F(TankTest, AFlowBeyondTheHorizonIsHeldHoweverItIsAskedFor) {
  const ObserverConfig slow =
      test::parse(test::replaced(kTank, "-2*sqrt(level - 0.01)", "-0.001*level"));
  Estimator patient(slow.law, slow.options);
  const double y = 0.0;
  ASSERT_TRUE(patient.submit({kStart, EventKind::kSample, 0, &y, 1, 0}, kStart).used());
  for (double t = 0.0; t < 4.95; t += 0.1) {  // step by step up to the horizon
    ASSERT_EQ(Timeline::Query::kOk, patient.estimate_at(kStart + from_seconds(t), estimate_));
  }
  EXPECT_EQ(Timeline::Query::kOk, patient.estimate_at(kStart + 5 * kSecond, estimate_));
  EXPECT_NEAR(std::exp(-0.005), estimate_.state(0), 1e-12);
  EXPECT_EQ(Timeline::Query::kHeld, patient.estimate_at(kStart + 5 * kSecond + 1, estimate_));
  EXPECT_EQ(1.0, estimate_.state(0));
}

}  // namespace
}  // namespace sampled_data_observers
