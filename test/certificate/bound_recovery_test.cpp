// Bounds beside true plants, where something goes otherwise than the theorem has it: what comes
// late, jumps that are told twice or are refused, pauses, other gains, angles that turn over.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "certificate/certified_gains.h"
#include "certificate/true_run.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

const char kImpulsive[] = "config/examples/bernard2022_impulsive/gains.yaml";
const char kScalar[] = "config/examples/ferrante2016_scalar/gains.yaml";
const char kMassSpring[] = "config/examples/ferrante2016_mass_spring/gains.yaml";
const char kOscillator[] = "test/certificate/ferrante2019_oscillator_0.2.yaml";
const char kOscillatorSlow[] = "test/certificate/ferrante2019_oscillator_0.41.yaml";

/// A gain file for a plant that is changed where its conditions don't look.
CertifiedGains with_plant(const char* gains, const std::string& change) {
  CertifiedGains result(gains);
  result.with(change);
  return result.with_own_hash();
}

struct Tally {
  int finite = 0;
  int infinite = 0;
  int exceeded = 0;

  void add(const TrueRun::Comparison& comparison) {
    if (!comparison.holds()) ++exceeded;
    ++(std::isfinite(comparison.bound.value) ? finite : infinite);
  }
};

constexpr double kLatency = 0.05;
constexpr double kPeriod = 0.01;

/// What is published at once, and what is asked for when all has come.
struct LateRun {
  Tally published;
  Tally later;

  /// @param happen  lets happen what is due until a time
  template <class Happen>
  void play(TrueRun& run, double duration, const Happen& happen) {
    const int steps = static_cast<int>(duration / kPeriod);
    const int behind = static_cast<int>(std::ceil(kLatency / kPeriod));
    for (int i = 1; i <= steps; ++i) {
      const double now = i * kPeriod;
      happen(now);
      run.tell(now);
      published.add(run.compare(now));
      if (i > behind) later.add(run.compare((i - behind) * kPeriod, now));
    }
  }
};

LateRun run_with_late_jumps(const std::string& assumptions) {
  // So fast that x3, which becomes x1 at jumps, is far off until a jump is known.
  const ObserverConfig config = CertifiedGains(kImpulsive)
                                    .with("initial_estimate: {x1: 0, x2: 50, x3: 0}")
                                    .assuming(assumptions)
                                    .config();
  TrueRun run(config, Eigen::Vector3d(0.6, -0.5, 0.6));
  std::mt19937_64 generator(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  double next = uniform(2.0, 5.0);
  LateRun result;
  result.play(run, 60.0, [&](double now) {
    if (next > now) return;
    run.jump(next, uniform(0.02, kLatency));
    next += uniform(2.0, 5.0);
  });
  return result;
}

TEST(LateEventsTest, WithALatencyEveryPublishedBoundHoldsDespiteLateJumps) {
  const LateRun run = run_with_late_jumps(
      "{initial_error: 1, noise: 0, latency: " + std::to_string(kLatency) + "}");
  EXPECT_EQ(0, run.published.exceeded);
  EXPECT_EQ(0, run.published.finite);
  EXPECT_EQ(0, run.later.exceeded);
  EXPECT_EQ(0, run.later.infinite);
  EXPECT_GT(run.later.finite, 5000);
}

TEST(LateEventsTest, WithoutALatencyBoundsAreThoseOfARunWithoutTheLateJumps) {
  const LateRun run = run_with_late_jumps("{initial_error: 1, noise: 0}");
  EXPECT_GT(run.published.exceeded, 0);
  RecordProperty("exceeded", run.published.exceeded);
  RecordProperty("finite", run.published.finite);
  EXPECT_EQ(0, run.later.exceeded);
}

LateRun run_with_late_inputs(const std::string& assumptions) {
  const ObserverConfig config = with_plant(kOscillator, "plant: {inputs: [u], B: [[0], [20]]}")
                                    .assuming(assumptions)
                                    .config();
  TrueRun run(config, Eigen::Vector2d(0.01, 0.0));
  double next_input = 0.333;
  double next_sample = 0.0;
  LateRun result;
  result.play(run, 20.0, [&](double now) {
    while (std::min(next_input, next_sample) <= now) {
      if (next_input < next_sample) {
        run.input(next_input, std::sin(3.0 * next_input), kLatency);
        next_input += 0.333;
      } else {
        run.sample(next_sample);
        next_sample += 0.15;
      }
    }
  });
  return result;
}

TEST(LateEventsTest, WithALatencyEveryPublishedBoundHoldsDespiteLateInputs) {
  const LateRun run = run_with_late_inputs(
      "{initial_error: 0.01, noise: 0, disturbance: 0, latency: " + std::to_string(kLatency) + "}");
  EXPECT_EQ(0, run.published.exceeded);
  EXPECT_EQ(0, run.published.finite);
  EXPECT_EQ(0, run.later.exceeded);
  EXPECT_EQ(0, run.later.infinite);
}

TEST(LateEventsTest, WithoutALatencyBoundsAreThoseOfARunWithoutTheLateInputs) {
  const LateRun run = run_with_late_inputs("{initial_error: 0.01, noise: 0, disturbance: 0}");
  EXPECT_GT(run.published.exceeded, 0);
  RecordProperty("exceeded", run.published.exceeded);
  RecordProperty("finite", run.published.finite);
  EXPECT_EQ(0, run.later.exceeded);
}

/// Compares every 10 ms from after `from` to `to`; the last comparison.
TrueRun::Comparison hold_throughout(TrueRun& run, double from, double to) {
  TrueRun::Comparison last;
  for (int i = 1; from + i * kPeriod <= to + 1e-9; ++i) {
    last = run.compare(from + i * kPeriod);
    EXPECT_TRUE(last.holds()) << from + i * kPeriod << " s: " << last.error << " > "
                              << last.bound.value;
    EXPECT_TRUE(std::isfinite(last.bound.value)) << from + i * kPeriod << " s";
  }
  return last;
}

/// The bound after jumps every 3 s, from 5 s on; it holds all along.
double after_regular_jumps(TrueRun& run) {
  double last = 0.0;
  for (double at = 5.0; at < 60.0; at += 3.0) {
    run.jump(at, 0.0);
    run.tell(at);
    last = hold_throughout(run, at - kPeriod, at + 2.9).bound.value;
  }
  return last;
}

TEST(BoundRecoveryTest, AJumpSoonAfterAnotherCountsAsRealAndAsToldTwice) {
  for (const bool is_real : {false, true}) {
    const ObserverConfig config =
        CertifiedGains(kImpulsive).assuming("{initial_error: 1, noise: 0}").config();
    TrueRun run(config, Eigen::Vector3d(0.6, -0.5, 0.6));
    run.jump(2.0, 0.0);
    run.tell(2.0);
    const double before = hold_throughout(run, 0.0, 2.3).bound.value;
    if (is_real) {
      run.jump(2.3, 0.0);
    } else {
      run.false_jump(2.3);
    }
    run.tell(2.3);
    const double after = hold_throughout(run, 2.29, 5.0).bound.value;
    EXPECT_GT(after, before) << is_real;
    EXPECT_LT(after_regular_jumps(run), after) << is_real;
  }
}

TEST(BoundRecoveryTest, TheBoundHoldsOfJumpsWhoseOutputsAGateKeepsOut) {
  const char kSensor[] =
      "sensors: {position: {gate: {innovation: 0.2, recovery: {after: 100, action: accept}}}}";
  const ObserverConfig config =
      with_plant(kImpulsive, kSensor).assuming("{initial_error: 1, noise: 0}").config();
  TrueRun run(config, Eigen::Vector3d(0.1, -0.5, 0.1));
  double before = 0.0;
  for (int i = 1; i <= 20; ++i) {
    const bool is_outlier = i == 10;
    run.jump(2.5 * i, 0.0, 0.0, is_outlier ? 50.0 : 0.0);
    run.tell(2.5 * i);
    EXPECT_EQ(is_outlier ? EventOutcome::kJumpAlone : EventOutcome::kUsed,
              run.reports().back().outcome);
    for (const double after : {0.0, 1.0, 2.4}) {
      EXPECT_TRUE(run.compare(2.5 * i + after).holds()) << i;
    }
    const double bound = run.compare(2.5 * i).bound.value;
    if (i > 2) {
      EXPECT_EQ(is_outlier, bound > before) << i;
    }
    before = bound;
  }
}

TEST(BoundRecoveryTest, AJumpThatNobodyToldOfTakesTheBoundAway) {
  for (const char* action : {"report", "predict"}) {
    const ObserverConfig config =
        CertifiedGains("test/certificate/bernard2022_bouncing_ball_equation26.yaml")
            .with("plant: {flow_set: [-theta]}\njumps: {missing: {margin: 0.5, action: " +
                  std::string(action) + "}}")
            .assuming("{initial_error: 0.1, noise: 0}")
            .config();
    Estimator estimator(config.law, config.options);
    estimator.restart(kStart, Eigen::Vector2d(5.0, 0.0));
    Estimate estimate = estimator.make_estimate();
    const auto bound_after = [&](double seconds) {
      EXPECT_EQ(Timeline::Query::kOk,
                estimator.estimate_at(kStart + from_seconds(seconds), estimate));
      return config.law->error_bound(estimate.state.data());
    };
    EXPECT_TRUE(std::isfinite(bound_after(0.9))) << action;  // it is at the floor after 1.03 s
    EXPECT_FALSE(std::isfinite(bound_after(1.5))) << action;
    EXPECT_EQ(1.0, config.law->missing_jumps(estimate.state.data())) << action;
    EXPECT_EQ(BoundLoss::kNotVouched, config.law->bound_loss(estimate.state.data())) << action;
  }
}

/// An impulsive plant whose jumps are told by numbers.
struct NumberedRun {
  explicit NumberedRun(const std::string& jumps = "{}")
      : config(CertifiedGains(kImpulsive)
                   .with("jumps: " + jumps)
                   .assuming("{initial_error: 1, noise: 0}")
                   .config()),
        estimator(config.law, config.options) {
    estimator.restart(kRunStart);
  }

  void jump(double seconds, std::uint32_t index, EventKind kind = EventKind::kJump) {
    const double y = 0.0;
    Event event{kRunStart + from_seconds(seconds), kind, 0, &y, 1};
    event.index = index;
    estimator.submit(event, kRunStart + from_seconds(60.0));
  }
  BoundLoss loss_at(double seconds) {
    EstimateQuery query;
    estimator.begin_query(kRunStart + from_seconds(seconds), kRunStart + from_seconds(60.0), query);
    while (!query.proceed(1000)) {
    }
    const PublishedBound bound = query.bound();
    EXPECT_EQ(bound.loss == BoundLoss::kNone, std::isfinite(bound.value));
    return bound.loss;
  }

  ObserverConfig config;
  Estimator estimator;
};

TEST(BoundRecoveryTest, AJumpThatWasLostTakesTheBoundAwayFromTheLastOneToldOn) {
  NumberedRun run;
  run.jump(0.5, 1);
  run.jump(1.5, 3);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(0.4));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(0.5));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(1.6));
  run.jump(1.0, 2);  // it was only late
  for (const double time : {0.4, 0.5, 1.2, 1.6}) {
    EXPECT_EQ(BoundLoss::kNone, run.loss_at(time)) << time;
  }
}

TEST(BoundRecoveryTest, AWithdrawalThatIsRejectedLeavesAJumpThatWasNone) {
  NumberedRun run;
  run.jump(0.5, 1);
  run.jump(1.0, 2);
  run.jump(1.0, 2, EventKind::kWithdrawal);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(1.5));
  Event late;
  late.stamp = kRunStart + from_seconds(1.2);
  late.kind = EventKind::kWithdrawal;
  run.estimator.note_rejected(late, kRunStart + from_seconds(60.0));
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(1.1));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(1.5));
}

TEST(BoundRecoveryTest, JumpsAtOtherTimesThanConfiguredTakeTheBoundAway) {
  NumberedRun overdue("{dwell_time: [0.1, 1]}");
  overdue.jump(0.5, 1);
  EXPECT_EQ(BoundLoss::kNone, overdue.loss_at(1.5));
  EXPECT_EQ(BoundLoss::kDwellTimes, overdue.loss_at(1.51));
  overdue.jump(1.4, 2);
  EXPECT_EQ(BoundLoss::kNone, overdue.loss_at(1.51));
  NumberedRun many("{average_dwell_time: {tau: 1, N0: 2}}");
  many.jump(0.5, 1);
  many.jump(0.9, 2);
  EXPECT_EQ(BoundLoss::kNone, many.loss_at(1.0));
  many.jump(1.3, 3);
  EXPECT_EQ(BoundLoss::kNone, many.loss_at(1.2));
  EXPECT_EQ(BoundLoss::kDwellTimes, many.loss_at(1.4));
}

TEST(BoundRecoveryTest, AnEstimateThatIsTakenToBeAtRestHasNone) {
  NumberedRun run("{rest: {set: [x1], margin: 1000, state: {x1: 0}}}");
  run.jump(0.5, 1);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(0.4));
  EXPECT_EQ(BoundLoss::kAtRest, run.loss_at(0.6));
}

TEST(BoundRecoveryTest, AJumpThatIsRefusedMayHaveBeenOneOrNot) {
  for (const bool is_real : {false, true}) {
    const ObserverConfig config = CertifiedGains(kImpulsive)
                                      .with("jumps: {min_separation: 0.5}")
                                      .assuming("{initial_error: 1, noise: 0}")
                                      .config();
    TrueRun run(config, Eigen::Vector3d(0.6, -0.5, 0.6));
    run.jump(2.0, 0.0);
    if (is_real) {
      run.jump(2.3, 0.0);
    } else {
      run.false_jump(2.3);
    }
    run.tell(2.3);
    ASSERT_EQ(EventOutcome::kTooFrequent, run.reports().back().outcome);
    const double after = hold_throughout(run, 2.29, 5.0).bound.value;
    EXPECT_LT(after_regular_jumps(run), after) << is_real;
  }
}

const char kHeld[] = "test/certificate/attack/held/bernard2022_equation22.yaml";

TEST(BoundRecoveryTest, AHeldOutputIsWorthLessTheOlderItIs) {
  const auto bound_after = [](double output_rate, double seconds) {
    CertifiedGains gains(kHeld);
    gains.assuming("{initial_error: 1, noise: 0, disturbance: 0, output_rate: " +
                   std::to_string(output_rate) + "}");
    const ObserverConfig config = gains.config();
    Estimator estimator(config.law, config.options);
    estimator.restart(kStart);
    const double y = 0.3;
    estimator.submit({kStart + kSecond / 10, EventKind::kOutput, 0, &y, 1}, kStart + kSecond);
    Estimate estimate = estimator.make_estimate();
    EXPECT_EQ(Timeline::Query::kOk,
              estimator.estimate_at(kStart + from_seconds(0.1 + seconds), estimate));
    return config.law->error_bound(estimate.state.data());
  };
  // The proof itself, with the rate of flow_decay / 2.
  const double at_message = bound_after(0.0, 0.0);
  EXPECT_NEAR(std::exp(-0.3757807377418633 / 2.0 * 1.5), bound_after(0.0, 1.5) / at_message, 1e-6);
  // The error of what is held grows with the time, and what it makes of the error with its square.
  const double of_rate = bound_after(1.0, 0.02) - bound_after(0.0, 0.02);
  EXPECT_NEAR(2.0 * of_rate, bound_after(2.0, 0.02) - bound_after(0.0, 0.02), 1e-6 * of_rate);
  EXPECT_NEAR(4.0 * of_rate, bound_after(1.0, 0.04) - bound_after(0.0, 0.04), 0.01 * of_rate);
}

TEST(BoundRecoveryTest, WhatIsHeldWhenAnEstimateBeginsAnewIsKnownByItsInnovation) {
  const ObserverConfig config =
      CertifiedGains(kHeld)
          .assuming("{initial_error: 0.1, noise: 0, disturbance: 0, output_rate: 0}")
          .config();
  const auto bound_after = [&](double estimate_of_position) {
    Estimator estimator(config.law, config.options);
    estimator.restart(kStart);
    const double y = 0.0;
    estimator.submit({kStart + 1, EventKind::kOutput, 0, &y, 1}, kStart + 1);
    estimator.restart(kStart + kSecond, Eigen::Vector2d(estimate_of_position, 0.0));
    Estimate estimate = estimator.make_estimate();
    EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + 2 * kSecond, estimate));
    return config.law->error_bound(estimate.state.data());
  };
  // A plant at 5, say, has nothing to do with a 0 that was measured long ago.
  EXPECT_GT(bound_after(5.0), 5.0);
  EXPECT_LT(bound_after(5.0), 500.0);
  EXPECT_LT(bound_after(0.0), 5.0);
}

TEST(BoundRecoveryTest, AJumpThatIsRefusedLeavesAnOldOutputHeld) {
  const ObserverConfig config =
      CertifiedGains(kHeld)
          .with("jumps: {min_separation: 0.1}")
          .assuming("{initial_error: 1, noise: 0, disturbance: 0, output_rate: 3}")
          .config();
  Estimator estimator(config.law, config.options);
  estimator.restart(kStart);
  const Stamp at = kStart + kSecond;
  const Stamp again = at + kSecond / 20;
  const double y_d = 0.0;
  EXPECT_TRUE(estimator.submit({at, EventKind::kJump, 0, &y_d, 1}, at).used());
  const double y = 0.9;
  EXPECT_TRUE(estimator.submit({at + 1, EventKind::kOutput, 0, &y, 1}, at + 1).used());
  Estimate estimate = estimator.make_estimate();
  const auto bound_at = [&](Stamp stamp) {
    EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(stamp, estimate));
    return config.law->error_bound(estimate.state.data());
  };
  const double without = bound_at(again + kSecond / 100);
  EXPECT_EQ(EventOutcome::kTooFrequent,
            estimator.submit({again, EventKind::kJump, 0, &y_d, 1}, again).outcome);
  EXPECT_GT(bound_at(again + kSecond / 100), without);
  EXPECT_TRUE(std::isfinite(bound_at(again + kSecond / 100)));
}

TEST(BoundRecoveryTest, ASwitchThatIsRefusedMayHaveChangedTheMode) {
  const ObserverConfig config = CertifiedGains("config/examples/bernard2022_switched/gains.yaml")
                                    .with("jumps: {min_separation: 0.1}")
                                    .assuming("{initial_error: 1, noise: 0}")
                                    .config();
  Estimator estimator(config.law, config.options);
  estimator.restart(kStart);
  const double y = 0.2;
  const auto outcome = [&](Stamp stamp, double mode) {
    Event event{stamp, EventKind::kJump, 0, &y, 1, 0};
    event.mode = mode;
    return estimator.submit(event, stamp).outcome;
  };
  Estimate estimate = estimator.make_estimate();
  const auto loss_at = [&](Stamp stamp) {
    EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(stamp, estimate));
    return config.law->bound_loss(estimate.state.data());
  };
  EXPECT_EQ(EventOutcome::kUsed, outcome(kStart + kSecond, 2.0));
  EXPECT_EQ(BoundLoss::kNone, loss_at(kStart + kSecond + kSecond / 20));
  EXPECT_EQ(EventOutcome::kTooFrequent, outcome(kStart + kSecond + kSecond / 20, 1.0));
  EXPECT_EQ(BoundLoss::kUnknownJump, loss_at(kStart + 2 * kSecond));
}

TEST(BoundRecoveryTest, APauseIsATimeWithoutSamples) {
  const ObserverConfig config =
      CertifiedGains(kMassSpring).assuming("{initial_error: 1, noise: 0.01}").config();
  Eigen::VectorXd error = Eigen::VectorXd::Zero(config.plant->states());
  error(0) = 0.9;
  TrueRun run(config, error);
  const auto sample = [&](double from, double to) {
    for (double at = from; at < to; at += 1.0) {
      run.sample(at, at < 10.0 ? 0.01 : -0.01);
      run.tell(at);
      hold_throughout(run, at, at + 0.95);
    }
  };
  sample(1.0, 10.0);
  const double before = run.compare(10.0).bound.value;
  run.estimator().resume(TrueRun::stamp_of(20.0));
  const double after = run.compare(20.01).bound.value;
  EXPECT_TRUE(run.compare(20.01).holds());
  EXPECT_GT(after, before);
  sample(20.5, 90.0);
  EXPECT_LT(run.compare(90.4).bound.value, 2.0 * before);
}

TEST(BoundRecoveryTest, OtherGainsGoOnFromWhatIsKnownOfTheError) {
  const char kAssumed[] = "{initial_error: 10, noise: 0.01, disturbance: 0}";
  const ObserverConfig first = CertifiedGains(kOscillator).assuming(kAssumed).config();
  const ObserverConfig second = CertifiedGains(kOscillatorSlow).assuming(kAssumed).config();
  TrueRun run(first, Eigen::Vector2d(6.0, -8.0));
  for (int i = 1; i <= 200; ++i) {
    run.sample(0.15 * i, i % 2 == 0 ? 0.01 : -0.01);
    run.tell(0.15 * i);
  }
  const double before = run.compare(30.1).bound.value;
  TrueRun next(second, Eigen::Vector2d::Zero());
  next.estimator().take_over(run.estimator(), TrueRun::stamp_of(30.1));
  Estimate estimate = next.estimator().make_estimate();
  const auto bound_at = [&](double seconds) {
    EXPECT_EQ(Timeline::Query::kOk,
              next.estimator().estimate_at(TrueRun::stamp_of(seconds), estimate));
    return second.law->error_bound(estimate.state.data());
  };
  EXPECT_GE(bound_at(30.1), before);
  EXPECT_LT(bound_at(30.1), 10.0 * before);
  EXPECT_LT(bound_at(30.1), 5.0);
  // From gains without a bound nothing is known.
  const ObserverConfig unbounded = CertifiedGains(kOscillator).config();
  TrueRun without(unbounded, Eigen::Vector2d::Zero());
  next.estimator().take_over(without.estimator(), TrueRun::stamp_of(31.0));
  EXPECT_EQ(std::numeric_limits<double>::infinity(), bound_at(31.0));
  EXPECT_EQ(BoundLoss::kNotVouched, second.law->bound_loss(estimate.state.data()));
}

TEST(BoundRecoveryTest, TheBoundHoldsWhenASampleOfBeforeOtherGainsComesLate) {
  const char kAssumed[] = "{initial_error: 10, noise: 0.01, disturbance: 0}";
  const ObserverConfig first = CertifiedGains(kOscillator).assuming(kAssumed).config();
  const ObserverConfig second = CertifiedGains(kOscillatorSlow).assuming(kAssumed).config();
  TrueRun run(first, Eigen::Vector2d(6.0, -8.0));
  for (int i = 1; i <= 20; ++i) {
    run.sample(0.15 * i, i % 2 == 0 ? 0.01 : -0.01);
    if (i < 20) run.tell(0.15 * i);
  }
  Estimator next(second.law, second.options);
  next.take_over(run.estimator(), TrueRun::stamp_of(3.05));
  run.estimator() = std::move(next);
  const auto before = run.compare(3.06);
  EXPECT_TRUE(before.holds());
  run.tell(3.1);
  EXPECT_EQ(EventOutcome::kUsed, run.reports().back().outcome);
  const auto after = run.compare(3.06);
  EXPECT_TRUE(after.holds());
  EXPECT_NE(after.bound.value, before.bound.value);
  for (int i = 21; i <= 200; ++i) {
    run.sample(0.15 * i, i % 2 == 0 ? 0.01 : -0.01);
    run.tell(0.15 * i);
    EXPECT_TRUE(run.compare(0.15 * i).holds());
    EXPECT_TRUE(run.compare(0.15 * i + 0.149).holds());
  }
}

TEST(BoundRecoveryTest, AnInputThatIsUnknownStaysSoWithOtherGains) {
  const auto config = with_plant(kOscillator, "plant: {inputs: [u], B: [[0], [1]]}")
                          .assuming("{initial_error: 1, noise: 0, disturbance: 0}")
                          .config();
  TrueRun run(config, Eigen::Vector2d(0.5, 0.0));
  run.sample(0.1);
  run.tell(0.1);
  run.estimator().note_rejected({TrueRun::stamp_of(0.2), EventKind::kInput, 0, nullptr, 0, 0},
                                TrueRun::stamp_of(0.2));
  TrueRun next(config, Eigen::Vector2d::Zero());
  next.estimator().take_over(run.estimator(), TrueRun::stamp_of(0.3));
  EXPECT_EQ(BoundLoss::kUnknownInput, next.compare(0.4).bound.loss);
  next.estimator().restart(TrueRun::stamp_of(0.5));
  EXPECT_EQ(BoundLoss::kUnknownInput, next.compare(0.6).bound.loss);
}

TEST(BoundRecoveryTest, AnAngleWhoseTurnIsKnownCostsNothing) {
  const auto config = with_plant(kScalar, "sensors: {y: {angular: [true]}}")
                          .assuming("{initial_error: 3.5, noise: 0.01}")
                          .config();
  TrueRun run(config, Eigen::VectorXd::Constant(1, 1.0));
  // The bound is above pi, but the innovation of 1.1 fits no other number of turns.
  EXPECT_GT(run.compare(0.1).bound.value, 3.8);
  run.sample(0.1, 0.01);
  run.tell(0.1);
  EXPECT_LT(hold_throughout(run, 0.09, 0.2).bound.value, 0.02);
}

TEST(BoundRecoveryTest, AnAngleThatMayHaveTurnedMovesTheBoundByWhatTheEstimateMoved) {
  const auto config = with_plant(kScalar, "sensors: {y: {angular: [true]}}")
                          .assuming("{initial_error: 20, noise: 0.01}")
                          .config();
  // One turn and some more: the sample takes the estimate to a turn away from the state.
  TrueRun run(config, Eigen::VectorXd::Constant(1, 7.0));
  const double before = run.compare(0.1).bound.value;
  run.sample(0.1, 0.01);
  run.tell(0.1);
  const TrueRun::Comparison after = run.compare(0.1);
  EXPECT_TRUE(after.holds());
  EXPECT_NEAR(after.error, 2.0 * std::acos(-1.0), 0.1);
  EXPECT_GT(after.bound.value, before);
  EXPECT_LT(after.bound.value, before + 3.2);
  hold_throughout(run, 0.1, 1.0);
}

}  // namespace
}  // namespace sampled_data_observers::test
