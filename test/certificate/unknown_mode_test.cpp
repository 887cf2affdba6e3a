// Bounds of switched plants: where an event leaves open in which mode the plant is, and where one
// that is told again does not.
#include <gtest/gtest.h>

#include <cmath>

#include "certificate/certified_gains.h"
#include "certificate/guaranteed_bound.h"
#include "sampled_data_observers/observer/plant_observer.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

constexpr char kSwitchedGains[] = "test/certificate/attack/switched/bernard2022_example7_1.yaml";
constexpr char kSwitchedAssumptions[] =
    "{initial_error: 0.001, noise: 0, disturbance: 0, output_rate: 3}";

ObserverConfig switched_config(const std::string& jumps = "{}") {
  return CertifiedGains(kSwitchedGains)
      .with("jumps: " + jumps)
      .assuming(kSwitchedAssumptions)
      .config();
}

Event to_mode(double mode, Stamp stamp, std::uint32_t index = 0) {
  Event event{stamp, EventKind::kJump, 0, nullptr, 0};
  event.mode = mode;
  event.index = index;
  return event;
}

/// Events come when they are stamped, unless said otherwise.
class SwitchedRun {
 public:
  explicit SwitchedRun(const ObserverConfig& config) : SwitchedRun(config, config.law) {}
  SwitchedRun(const ObserverConfig& config, const std::shared_ptr<const ObserverLaw>& law)
      : config_(config), estimator(law, config_.options) {
    estimator.restart(kStart, Eigen::Vector2d(10.0, 10.0));
  }

  EventOutcome tell(const Event& event, Duration later = 0) {
    return estimator.submit(event, event.stamp + later).outcome;
  }
  PublishedBound bound_at(Stamp stamp) {
    const Estimate* estimate = nullptr;
    EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(stamp, estimate));
    return estimator.bound(*estimate, stamp + kSecond);
  }
  BoundLoss loss_at(Stamp stamp) { return bound_at(stamp).loss; }

 private:
  ObserverConfig config_;

 public:
  Estimator estimator;
};

TEST(UnknownModeTest, AResetDoesNotHelpUntilASwitchTellsTheMode) {
  SwitchedRun run(switched_config());
  EXPECT_EQ(EventOutcome::kUsed, run.tell(to_mode(2, kStart + kSecond)));
  run.estimator.restart(kStart + 2 * kSecond);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(kStart + 3 * kSecond));
  EXPECT_EQ(EventOutcome::kUnknownMode, run.tell(to_mode(7, kStart + 3 * kSecond)));
  for (int i = 4; i <= 6; ++i) run.estimator.restart(kStart + i * kSecond);
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(kStart + 7 * kSecond));
  EXPECT_EQ(EventOutcome::kUsed, run.tell(to_mode(1, kStart + 8 * kSecond)));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(kStart + 8 * kSecond));
  run.estimator.restart(kStart + 9 * kSecond);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(kStart + 10 * kSecond));
}

TEST(UnknownModeTest, ASwitchOfBeforeTheResetThatComesLateIsOne) {
  SwitchedRun run(switched_config());
  run.estimator.restart(kStart + 10 * kSecond);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(kStart + 11 * kSecond));
  EXPECT_EQ(EventOutcome::kTooOld, run.tell(to_mode(2, kStart + 9 * kSecond), 2 * kSecond));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(kStart + 11 * kSecond));
  run.estimator.restart(kStart + 12 * kSecond);
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(kStart + 13 * kSecond));
}

TEST(UnknownModeTest, ARefusedOrSkippedSwitchIsOne) {
  SwitchedRun refused(switched_config("{min_separation: 0.5}"));
  EXPECT_EQ(EventOutcome::kUsed, refused.tell(to_mode(2, kStart + kSecond)));
  EXPECT_EQ(EventOutcome::kTooFrequent, refused.tell(to_mode(1, kStart + kSecond + 1)));
  refused.estimator.restart(kStart + 2 * kSecond);
  EXPECT_EQ(BoundLoss::kUnknownJump, refused.loss_at(kStart + 3 * kSecond));

  SwitchedRun skipped(switched_config());
  EXPECT_EQ(EventOutcome::kUsed, skipped.tell(to_mode(2, kStart + kSecond, 1)));
  EXPECT_EQ(EventOutcome::kUsed, skipped.tell(to_mode(2, kStart + 2 * kSecond, 3)));
  EXPECT_EQ(BoundLoss::kUnknownJump, skipped.loss_at(kStart + 2 * kSecond));
  skipped.estimator.restart(kStart + 3 * kSecond);
  EXPECT_EQ(BoundLoss::kNone, skipped.loss_at(kStart + 4 * kSecond));
}

TEST(UnknownModeTest, ANumberThatIsRejectedIsNotSkippedAndLosesTheBound) {
  SwitchedRun run(switched_config());
  EXPECT_EQ(EventOutcome::kUsed, run.tell(to_mode(2, kStart + kSecond, 1)));
  EXPECT_EQ(EventOutcome::kUnknownMode, run.tell(to_mode(7, kStart + 2 * kSecond, 2)));
  EXPECT_EQ(EventOutcome::kUsed, run.tell(to_mode(1, kStart + 3 * kSecond, 3)));
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(2 * kSecond + kStart - 1));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(kStart + 2 * kSecond));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(kStart + 4 * kSecond));
  const Estimate* estimate = nullptr;
  run.estimator.estimate_at(kStart + 4 * kSecond, estimate);
  EXPECT_EQ(0.0, estimate->law->skipped_jumps(estimate->state.data()));
}

TEST(UnknownModeTest, GainsWithoutABoundBeforeDidNotWatchTheMode) {
  const ObserverConfig bounded = switched_config();
  SwitchedRun before(CertifiedGains(kSwitchedGains).config());
  SwitchedRun after(bounded);
  after.estimator.take_over(before.estimator, kStart + kSecond);
  EXPECT_EQ(BoundLoss::kNotVouched, after.loss_at(kStart + 2 * kSecond));
  after.estimator.restart(kStart + 2 * kSecond);
  EXPECT_EQ(BoundLoss::kUnknownJump, after.loss_at(kStart + 3 * kSecond));
}

TEST(RepeatedSwitchTest, OneOfTheSameNumberCostsNothing) {
  SwitchedRun run(switched_config());
  EXPECT_EQ(EventOutcome::kUsed, run.tell(to_mode(2, kStart + kSecond, 1)));
  const PublishedBound before = run.bound_at(kStart + 2 * kSecond);
  EXPECT_EQ(EventOutcome::kRepeated, run.tell(to_mode(2, kStart + kSecond + kSecond / 2, 1)));
  EXPECT_EQ(before.value, run.bound_at(kStart + 2 * kSecond).value);
  // Its number says that it is the same, its mode that it is not.
  EXPECT_EQ(EventOutcome::kRepeated, run.tell(to_mode(1, kStart + 2 * kSecond, 1)));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(kStart + 3 * kSecond));
}

/// A plant that is where the estimate was, and did not jump.
void expect_bound_of_a_jump_told_again(const ObserverConfig& config, const Event& jump,
                                       const Eigen::VectorXd& start) {
  Estimator estimator(config.law, config.options);
  estimator.restart(kStart, start);
  Estimate before = estimator.make_estimate();
  Estimate after = estimator.make_estimate();
  ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(jump.stamp, before));
  ASSERT_TRUE(estimator.submit(jump, jump.stamp).used());
  ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(jump.stamp, after));
  const Eigen::Index n = start.size();
  const double moved = (after.state.head(n) - before.state.head(n)).norm();
  EXPECT_GT(moved, 1.0);
  EXPECT_GE(config.law->error_bound(after.state.data()), moved);
}

TEST(ToldTwiceTest, TheFirstJumpOfABoundMayHaveBeenToldBefore) {
  expect_bound_of_a_jump_told_again(switched_config(), to_mode(1, kStart + kSecond / 10),
                                    Eigen::Vector2d(10.0, 10.0));
  const double y = 10.0;
  Event jump{kStart + kSecond / 10, EventKind::kJump, 0, &y, 1};
  expect_bound_of_a_jump_told_again(
      CertifiedGains("config/examples/bernard2022_impulsive/gains.yaml")
          .assuming("{initial_error: 0.001, noise: 0}")
          .config(),
      jump, Eigen::Vector3d(10.0, 20.0, 30.0));
  jump.mode = 1;
  expect_bound_of_a_jump_told_again(
      CertifiedGains("config/examples/bernard2022_switched/gains.yaml")
          .assuming("{initial_error: 0.001, noise: 0}")
          .config(),
      jump, Eigen::Vector3d(20.0, 10.0, 0.0));
}

/// As if the theorem let switches follow each other at once.
std::shared_ptr<const ObserverLaw> law_of_coinciding_jumps(const ObserverConfig& config) {
  CertifiedGains gains(kSwitchedGains);
  Certificate certificate = gains.certificate();
  certificate.subject.T1 = 0.0;
  ErrorAssumptions assumptions;
  assumptions.initial_error = 1.0;
  assumptions.output_rate = 3.0;
  return std::make_shared<const GuaranteedBound>(
      config.law,
      certificate.theorem->error_bound(certificate.subject, certificate.values, assumptions),
      config.plant, 0.0);
}

TEST(CoincidingJumpsTest, WithoutNumbersTheyTakeTheBoundAway) {
  const ObserverConfig config =
      CertifiedGains(kSwitchedGains).with("jumps: {min_separation: 0}").config();
  const auto law = law_of_coinciding_jumps(config);
  const Stamp at = kStart + kSecond;

  SwitchedRun same(config, law);
  EXPECT_EQ(EventOutcome::kUsed, same.tell(to_mode(2, at)));
  EXPECT_EQ(BoundLoss::kNone, same.loss_at(at + kSecond));
  EXPECT_EQ(EventOutcome::kDuplicate, same.tell(to_mode(2, at)));
  EXPECT_EQ(BoundLoss::kUnknownJump, same.loss_at(at + kSecond));

  SwitchedRun others(config, law);
  others.tell(to_mode(2, at));
  others.tell(to_mode(1, at));
  EXPECT_EQ(BoundLoss::kUncertainJump, others.loss_at(at + kSecond));

  SwitchedRun numbered(config, law);
  numbered.tell(to_mode(2, at, 1));
  EXPECT_EQ(EventOutcome::kUsed, numbered.tell(to_mode(1, at, 2)));
  EXPECT_EQ(EventOutcome::kDuplicate, numbered.tell(to_mode(1, at, 2)));
  EXPECT_EQ(BoundLoss::kNone, numbered.loss_at(at + kSecond));
}

TEST(CoincidingJumpsTest, ThatOfBeforeOtherGainsTakesTheirBoundAwayToo) {
  const ObserverConfig config = CertifiedGains(kSwitchedGains).config();
  const auto law = law_of_coinciding_jumps(config);
  const Stamp at = kStart + kSecond;
  SwitchedRun before(config, law);
  before.tell(to_mode(2, at));
  SwitchedRun after(config, law);
  after.estimator.take_over(before.estimator, at + kSecond / 10);
  EXPECT_EQ(BoundLoss::kNone, after.loss_at(at + kSecond));
  EXPECT_EQ(EventOutcome::kDuplicate, after.tell(to_mode(2, at), kSecond / 5));
  EXPECT_EQ(BoundLoss::kUnknownJump, after.loss_at(at + kSecond));
}

}  // namespace
}  // namespace sampled_data_observers::test
