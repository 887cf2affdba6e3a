// Where a flow is longer than can be computed, or not finite, the state is held, and time goes on
// for all that counts it.
#include <gtest/gtest.h>

#include <cmath>

#include "observer/time_varying_gain_observer.h"
#include "plant/linear_plant.h"
#include "sampled_data_observers/config/yaml_file.h"
#include "support/stamps.h"
#include "support/type_examples.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

constexpr Duration kQuiet = 120 * kSecond;

/// An observer type of test/types with a horizon below kQuiet, and what else is given.
ObserverConfig with_horizon(const std::string& type, const std::string& yaml) {
  const std::string file = std::string(SDO_SOURCE_DIR) + "/test/types/" + type + ".yaml";
  const std::string horizon = "plant: {integration: {horizon: 100}}\nhistory: {duration: 1000}\n";
  const ConfigNode base = override_with(read_yaml_file(file), read_yaml_text(horizon, "test.yaml"));
  return read_observer_config(override_with(base, read_yaml_text(yaml, "test.yaml")),
                              no_plant_plugins);
}

class QuietTimesTest : public ::testing::Test {
 protected:
  static EventReport take(Estimator& estimator, const OwnedEvent& event, Duration delay = 0) {
    Event view = event.view();
    view.release = event.stamp + delay;
    return estimator.submit(view, kStart + 100 * kQuiet);
  }
  static Estimate at(const Estimator& estimator, Stamp stamp) {
    Estimate estimate = estimator.make_estimate();
    EXPECT_NE(Timeline::Query::kNoEvent, estimator.estimate_at(stamp, estimate));
    return estimate;
  }
  static OwnedEvent input(Stamp stamp) { return {stamp, EventKind::kInput, 0, {0.3}}; }
  static OwnedEvent jump(Stamp stamp) { return {stamp, EventKind::kJump, 0, {}}; }
};

TEST_F(QuietTimesTest, JumpsFarApartAreNeverTooFrequent) {
  const ObserverConfig config =
      with_horizon("constant_gain_nonlinear", "jumps: {min_separation: 1, max_per_second: 1}");
  Estimator estimator(config.law, config.options);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(EventOutcome::kUsed, take(estimator, jump(kStart + i * kQuiet)).outcome) << i;
  }
  EXPECT_EQ(EventOutcome::kTooFrequent,
            take(estimator, jump(kStart + 9 * kQuiet + kSecond / 2)).outcome);
}

TEST_F(QuietTimesTest, ADelayedJumpIsReleased) {
  const ObserverConfig config = with_horizon(
      "constant_gain_nonlinear", "jumps: {late: delayed}\ninitial_estimate: {angle: 0.1, rate: 1}");
  Estimator estimator(config.law, config.options);
  const Stamp stamp = kStart + kSecond;
  take(estimator, input(kStart));
  take(estimator, jump(stamp), kQuiet + 1);
  const Estimate flowed = at(estimator, stamp);
  const Estimate before = at(estimator, stamp + kQuiet);
  EXPECT_TRUE(before.held);
  EXPECT_EQ(flowed.state.head(2), before.state.head(2));
  const Estimate after = at(estimator, stamp + kQuiet + 1);
  EXPECT_EQ(flowed.state(0), after.state(0));
  EXPECT_EQ(-0.8 * flowed.state(1), after.state(1));
}

TEST_F(QuietTimesTest, AGateRecovers) {
  const ObserverConfig config = with_horizon(
      "constant_gain_nonlinear",
      "sensors: {s: {gate: {innovation: [0.1, 0.1], recovery: {after: 60, action: accept}}}}");
  Estimator estimator(config.law, config.options);
  const auto sample = [&](Stamp stamp, double rate) {
    return take(estimator, {stamp, EventKind::kSample, 0, {0.0, rate}});
  };
  EXPECT_TRUE(sample(kStart, 0.0).used());
  EXPECT_EQ(EventOutcome::kGated, sample(kStart + kSecond, 5.0).outcome);
  EXPECT_EQ(EventOutcome::kGated, sample(kStart + 2 * kSecond, 5.0).outcome);
  EXPECT_TRUE(sample(kStart + 2 * kSecond + kQuiet, 5.0).recovers());
}

TEST_F(QuietTimesTest, AnOutputMeasuredAtAJumpDoesNotBelongToTheOneBefore) {
  const ObserverConfig config = with_horizon("synchronized_nonlinear_delayed", "{}");
  // Without what lies around the law.
  const std::shared_ptr<const ObserverLaw> law(config.law, &config.law->observer());
  Estimator estimator(law, config.options);
  take(estimator, {kStart, EventKind::kInput, 0, {0.5}});
  take(estimator, jump(kStart + kSecond));
  const Stamp stamp = kStart + kSecond + kQuiet;
  const Estimate before = at(estimator, stamp);
  EXPECT_TRUE(take(estimator, {stamp, EventKind::kJumpOutput, 1, {7.0}}).used());
  EXPECT_EQ(before.state.head(2), at(estimator, stamp).state.head(2));
}

/// x' = 100 x beside a stable state: after some seconds without a sample it is held.
std::shared_ptr<const ObserverLaw> time_varying_law(Eigen::Index states,
                                                    const std::optional<Eigen::MatrixXd>& P) {
  LinearPlantDescription plant;
  plant.state_names = {"x", "y"};
  plant.state_names.resize(static_cast<std::size_t>(states));
  plant.A = -50.0 * Eigen::MatrixXd::Identity(states, states);
  plant.A(0, 0) = 100.0;
  plant.B = Eigen::MatrixXd::Zero(states, 0);
  plant.sensors = {{"s", Eigen::MatrixXd::Identity(1, states), {false}}};
  const ObserverContext context{make_linear_plant(plant), Eigen::VectorXd::Zero(states),
                                Eigen::VectorXd::Zero(0)};
  return std::make_shared<const TimeVaryingGainObserver>(context, P, 0.4);
}

Estimator::Options long_history() {
  Estimator::Options options;
  options.history = {1000 * kSecond, 100};
  options.sampling = {1, kSecond};
  return options;
}

TEST_F(QuietTimesTest, AGainIsTheOneForTheWholeTimeSinceTheSampleBefore) {
  Estimator estimator(time_varying_law(1, std::nullopt), long_history());
  take(estimator, {kStart, EventKind::kSample, 0, {2.0}});
  take(estimator, {kStart + kQuiet, EventKind::kSample, 0, {3.0}});
  const Estimate estimate = at(estimator, kStart + kQuiet);
  EXPECT_TRUE(estimate.held);
  // Nothing is kept of the error, which was lost long ago: K = 1 - 0.4 exp(-100 tau).
  EXPECT_NEAR(3.0, estimate.state(0), 1e-12);
}

TEST_F(QuietTimesTest, ASampleIsUsedHoweverLongTheTimeBefore) {
  Estimator estimator(time_varying_law(2, Eigen::MatrixXd::Identity(2, 2)), long_history());
  take(estimator, {kStart, EventKind::kSample, 0, {2.0}});
  for (int i = 1; i < 4; ++i) {
    const Stamp stamp = kStart + i * kQuiet;
    EXPECT_TRUE(take(estimator, {stamp, EventKind::kSample, 0, {3.0 + i}}).used()) << i;
  }
}

TEST_F(QuietTimesTest, WhoGoesOnFromAHeldEstimateHoldsIt) {
  const auto law = time_varying_law(1, std::nullopt);
  Estimator estimator(law, long_history());
  take(estimator, {kStart, EventKind::kSample, 0, {2.0}});
  EXPECT_FALSE(at(estimator, kStart).held);
  const Stamp quiet = kStart + kQuiet;
  estimator.resume(quiet);
  EXPECT_TRUE(at(estimator, quiet).held);
  EXPECT_FALSE(at(estimator, quiet + 1).held);
  Estimator successor(law, long_history());
  successor.take_over(estimator, quiet);
  EXPECT_TRUE(at(successor, quiet).held);
  EXPECT_FALSE(at(successor, quiet + 1).held);
  successor.restart(quiet);
  EXPECT_FALSE(at(successor, quiet).held);
}

TEST_F(QuietTimesTest, TimersMoveByHoldingAsTheyDoByAFlow) {
  for (const std::string& type : test::type_examples()) {
    const std::shared_ptr<const ObserverLaw> law = test::read_example(type).law;
    Eigen::VectorXd start(law->state_size());
    law->initialize(start.data());
    const auto flowed = [&](Duration duration) {
      Eigen::VectorXd state = start;
      Eigen::VectorXd workspace(law->workspace_size());
      law->flow(duration, state.data(), workspace.data());
      return state;
    };
    Eigen::VectorXd held = start;
    law->hold(kSecond, held.data());
    const Eigen::VectorXd once = flowed(kSecond);
    int moved = 0;
    for (Eigen::Index i = 0; i < held.size(); ++i) {
      if (held(i) == start(i)) continue;
      ++moved;
      EXPECT_EQ(once(i), held(i)) << type << ", entry " << i;
      EXPECT_EQ(static_cast<double>(kSecond), held(i) - start(i)) << type << ", entry " << i;
    }
    EXPECT_GE(moved, 1) << type;
  }
}

}  // namespace
}  // namespace sampled_data_observers
