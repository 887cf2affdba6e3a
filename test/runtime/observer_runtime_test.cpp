// Estimates at once after events, switching off and on, restarts and other gains.
#include "sampled_data_observers/runtime/observer_runtime.h"

#include <gtest/gtest.h>

#include <cmath>

#include "certificate/certified_gains.h"
#include "config/plant_fingerprint.h"
#include "sampled_data_observers/config/event_channels.h"
#include "sampled_data_observers/config/yaml_file.h"

namespace sampled_data_observers {
namespace {

ObserverConfig cart(const std::string& more, const std::string& L = "[[1], [5]]") {
  return read_observer_config(read_yaml_text(R"(
observer: ConstantGainObserver
plant: {states: [p, v], inputs: [u], A: [[0, 1], [0, 0]], B: [[0], [1]]}
sensors: {s: {C: [[1, 0]], source: {topic: s}}, t: {C: [[0, 1]], source: {topic: t}}}
sampling: {T1: 0.05, T2: 0.2}
rate: 100
gains: {L: {s: )" + L + ", t: [[0], [0]]}}\n" + more,
                                             "test.yaml"),
                              no_plant_plugins);
}

class LiveRuntimeTest : public ::testing::Test {
 protected:
  void make(const std::string& more) {
    const ObserverConfig config = cart(more);
    channels_ = event_channels(config);
    runtime_ = std::make_unique<ObserverRuntime>(config);
  }
  /// An event of channel 0 (s), 1 (t) or 2 (the input) that arrives at once.
  EventOutcome receive(std::size_t channel, Stamp stamp, double value) {
    const EventChannel& from = channels_[channel];
    return runtime_->receive({stamp, from.kind, from.sensor, &value, 1}, stamp).outcome;
  }
  std::vector<Stamp> due(Stamp now) {
    std::vector<Stamp> stamps;
    while (const Estimate* estimate = runtime_->next_due(now)) stamps.push_back(estimate->stamp);
    return stamps;
  }
  double position(Stamp stamp) {
    std::string reason;
    const Estimate* estimate = runtime_->estimate_at(stamp, reason);
    EXPECT_NE(nullptr, estimate) << reason;
    return estimate != nullptr ? estimate->state(0) : 0.0;
  }

  std::vector<EventChannel> channels_;
  std::unique_ptr<ObserverRuntime> runtime_;
};

using Stamps = std::vector<Stamp>;

TEST_F(LiveRuntimeTest, AnEstimateFollowsEachUsedEventAndNoStampIsRepeated) {
  make("publish_on_event: true");
  receive(0, 1'003'000'000, 2.0);
  EXPECT_EQ((Stamps{1'003'000'000}), due(1'003'000'000));
  receive(2, 1'004'000'000, 2.0);
  receive(1, 1'004'000'000, 2.0);
  EXPECT_EQ((Stamps{1'004'000'000}), due(1'004'000'000));
  EXPECT_EQ((Stamps{}), due(1'004'000'000));
  EXPECT_EQ(EventOutcome::kDuplicate, receive(1, 1'004'000'000, 2.0));
  EXPECT_EQ((Stamps{}), due(1'005'000'000));
  receive(0, 1'020'000'000, 2.0);
  EXPECT_EQ((Stamps{1'010'000'000, 1'020'000'000}), due(1'020'000'000));
  receive(0, 1'020'500'000, 2.0);
  EXPECT_EQ((Stamps{1'020'500'000}), due(1'020'500'000));
  EXPECT_EQ((Stamps{1'030'000'000}), due(1'030'000'000));
}

TEST_F(LiveRuntimeTest, SwitchedOffItRejectsAllAndGivesNoEstimate) {
  make("");
  receive(0, 1'000'000'000, 2.0);
  due(1'000'000'000);
  runtime_->set_enabled(false, 1'001'000'000);
  EXPECT_EQ(EventOutcome::kDisabled, receive(0, 1'050'000'000, 9.0));
  EXPECT_EQ(EventOutcome::kDisabled, receive(2, 1'050'000'000, 9.0));
  EXPECT_EQ((Stamps{}), due(1'100'000'000));
  std::string reason;
  EXPECT_EQ(nullptr, runtime_->estimate_at(1'000'000'000, reason));
  EXPECT_NE(std::string::npos, reason.find("switched off"));

  runtime_->set_enabled(true, 1'200'000'000);
  EXPECT_EQ((Stamps{1'210'000'000}), due(1'210'000'000));  // none of those missed
  EXPECT_NEAR(2.0 + 10.0 * 0.21, position(1'210'000'000), 1e-12);
  EXPECT_EQ(EventOutcome::kTooOld, receive(0, 1'150'000'000, 2.0));
  EXPECT_EQ(EventOutcome::kUsed, receive(0, 1'250'000'000, 2.0));
  runtime_->set_enabled(true, 1'300'000'000);  // it is: nothing changes
  EXPECT_EQ(EventOutcome::kUsedLate, receive(0, 1'240'000'000, 2.0));
}

TEST_F(LiveRuntimeTest, SensorsAreSwitchedOneByOne) {
  make("");
  EXPECT_NE(std::string::npos, runtime_->enable_sensor("x", false).find("(s, t), found 'x'"));
  EXPECT_EQ("", runtime_->enable_sensor("s", false));
  EXPECT_EQ(EventOutcome::kDisabled, receive(0, 1'000'000'000, 2.0));
  EXPECT_EQ(EventOutcome::kUsed, receive(1, 1'010'000'000, 2.0));
  EXPECT_EQ(EventOutcome::kUsed, receive(2, 1'020'000'000, 2.0));
  EXPECT_EQ("", runtime_->enable_sensor("s", true));
  EXPECT_EQ(EventOutcome::kUsed, receive(0, 1'030'000'000, 2.0));
}

TEST_F(LiveRuntimeTest, AtTheNextSampleItBeginsThere) {
  make("");
  receive(0, 1'000'000'000, 2.0);
  EXPECT_EQ("", runtime_->restart_at_next_sample(1'005'000'000));
  EXPECT_EQ((Stamps{}), due(1'100'000'000));
  std::string reason;
  EXPECT_EQ(nullptr, runtime_->estimate_at(1'050'000'000, reason));
  EXPECT_NE(std::string::npos, reason.find("next sample"));
  EXPECT_EQ(EventOutcome::kUsed, receive(0, 1'105'000'000, 7.0));
  EXPECT_EQ((Stamps{1'110'000'000}), due(1'110'000'000));
  EXPECT_NEAR(7.0, position(1'105'000'000), 1e-12);
}

TEST_F(LiveRuntimeTest, StartedAnewItGivesStampsOfThePastAgain) {
  make("");
  receive(0, 9'000'000'000, 2.0);
  EXPECT_EQ((Stamps{9'000'000'000}), due(9'000'000'000));
  runtime_->start_anew(1'000'000'000);
  EXPECT_EQ((Stamps{}), due(1'000'000'000));
  EXPECT_EQ(EventOutcome::kUsed, receive(0, 1'005'000'000, 2.0));
  EXPECT_EQ((Stamps{1'010'000'000}), due(1'015'000'000));
}

TEST_F(LiveRuntimeTest, OtherGainsGoOnWhereTheOldOnesWere) {
  make("");
  receive(2, 1'000'000'000, 3.0);
  receive(0, 1'000'000'000, 2.0);
  due(1'000'000'000);
  runtime_->enable_sensor("t", false);
  const double before = position(1'100'000'000);
  const double later = position(1'200'000'000);
  auto next = std::make_unique<ObserverRuntime>(cart("", "[[0.5], [0]]"));
  EXPECT_EQ(9u, due(1'090'000'000).size());
  next->take_over(*runtime_, 1'100'000'000);
  runtime_ = std::move(next);
  EXPECT_NEAR(before, position(1'100'000'000), 1e-12);
  EXPECT_NEAR(later, position(1'200'000'000), 1e-12);
  EXPECT_EQ((Stamps{1'100'000'000, 1'110'000'000}), due(1'110'000'000));
  EXPECT_EQ(EventOutcome::kDisabled, receive(1, 1'150'000'000, 2.0));
  EXPECT_EQ(EventOutcome::kUsed, receive(0, 1'200'000'000, later + 1.0));
  EXPECT_NEAR(later + 0.5, position(1'200'000'000), 1e-12);
  // A sample of before corrects as it would have then.
  const double old = position(1'050'000'000);
  EXPECT_EQ(EventOutcome::kUsedLate, receive(0, 1'050'000'000, old + 1.0));
  EXPECT_NEAR(old + 1.0, position(1'050'000'000), 1e-12);
}

TEST_F(LiveRuntimeTest, OtherGainsLeaveNoGapInDelayedEstimates) {
  make("publish_delay: 0.05");
  receive(0, 1'000'000'000, 2.0);
  EXPECT_EQ((Stamps{1'000'000'000}), due(1'051'000'000));
  auto next = std::make_unique<ObserverRuntime>(cart("publish_delay: 0.05", "[[0.5], [0]]"));
  next->take_over(*runtime_, 1'055'000'000);
  runtime_ = std::move(next);
  EXPECT_EQ((Stamps{1'010'000'000, 1'020'000'000}), due(1'070'000'000));
}

/// With a bound on its error: the oscillator's gain file, for a plant with an input.
class BoundedRuntimeTest : public ::testing::Test {
 protected:
  static ObserverConfig config_with(const std::string& assumptions) {
    test::CertifiedGains gains("test/certificate/ferrante2019_oscillator_0.2.yaml");
    gains.with("{plant: {inputs: [u], B: [[0], [1]]}, rate: 100}");
    gains.with("certificate: {plant: {hash: " + plant_fingerprint(gains.tree()) + "}}");
    return gains.assuming(assumptions).config();
  }
  void make(const std::string& more) {
    const ObserverConfig config =
        config_with("{initial_error: 1, noise: 0, disturbance: 0" + more + "}");
    channels_ = event_channels(config);
    runtime_ = std::make_unique<ObserverRuntime>(config);
  }
  /// Channel 0 is the sensor, 1 the input.
  EventReport receive(std::size_t channel, Stamp stamp, double value, Stamp now) {
    const EventChannel& from = channels_[channel];
    return runtime_->receive({stamp, from.kind, from.sensor, &value, 1}, now);
  }
  PublishedBound last_due(Stamp now) {
    PublishedBound bound;
    while (const Estimate* estimate = runtime_->next_due(now)) bound = runtime_->bound(*estimate);
    return bound;
  }

  std::vector<EventChannel> channels_;
  std::unique_ptr<ObserverRuntime> runtime_;
};

TEST_F(BoundedRuntimeTest, CountsWhatComesAfterABoundThatRestedOnItsAbsence) {
  make("");
  receive(1, 1'000'000'000, 0.0, 1'000'000'000);
  EXPECT_FALSE(receive(0, 1'000'000'000, 0.0, 1'000'000'000).came_after_bound);
  EXPECT_TRUE(std::isfinite(last_due(1'100'000'000).value));
  EXPECT_FALSE(receive(1, 1'100'000'001, 1.0, 1'105'000'000).came_after_bound);
  // At its own stamp it has changed nothing yet.
  EXPECT_FALSE(receive(1, 1'100'000'000, 1.0, 1'105'000'000).came_after_bound);
  EXPECT_TRUE(receive(1, 1'090'000'000, 2.0, 1'106'000'000).came_after_bound);
  EXPECT_FALSE(receive(1, 1'090'000'000, 2.0, 1'107'000'000).came_after_bound);  // a duplicate
  // A sample that is not there makes a bound no less true.
  EXPECT_FALSE(receive(0, 1'090'000'000, 0.0, 1'106'000'000).came_after_bound);
}

TEST_F(BoundedRuntimeTest, CountsNothingThatComesWithinTheLatency) {
  make(", latency: 0.05");
  receive(1, 1'000'000'000, 0.0, 1'000'000'000);
  receive(0, 1'000'000'000, 0.0, 1'000'000'000);
  EXPECT_EQ(BoundLoss::kStillOnTheirWay, last_due(1'100'000'000).loss);
  EXPECT_FALSE(receive(1, 1'060'000'000, 1.0, 1'105'000'000).came_after_bound);
}

TEST_F(BoundedRuntimeTest, KeepsItsBoundOverAPauseInWhichNoInputCame) {
  for (const bool input_comes : {false, true}) {
    make("");
    receive(1, 1'000'000'000, 0.0, 1'000'000'000);
    receive(0, 1'000'000'000, 0.0, 1'000'000'000);
    last_due(1'000'000'000);
    runtime_->set_enabled(false, 1'100'000'000);
    receive(0, 1'150'000'000, 0.0, 1'150'000'000);
    if (input_comes) receive(1, 1'150'000'000, 1.0, 1'150'000'000);
    runtime_->set_enabled(true, 1'300'000'000);
    const PublishedBound bound = last_due(1'310'000'000);
    EXPECT_EQ(input_comes ? BoundLoss::kUnknownInput : BoundLoss::kNone, bound.loss);
    EXPECT_EQ(input_comes, std::isinf(bound.value));
  }
}

TEST(UncertainJumpsRuntimeTest, AJumpStampedALittleAfterABoundMayHaveBeenBeforeIt) {
  const ObserverConfig config =
      test::CertifiedGains("config/examples/bernard2022_impulsive/gains.yaml")
          .with("{rate: 100, publish_delay: 0.05, jumps: {stamp_error: 0.05}}")
          .assuming("{initial_error: 1, noise: 0}")
          .config();
  ObserverRuntime runtime(config);
  const auto jump = [&](Stamp stamp, Stamp now) {
    const double y = 0.0;
    return runtime.receive({stamp, EventKind::kJump, 0, &y, 1}, now);
  };
  EXPECT_TRUE(jump(1'000'000'000, 1'000'000'000).used());
  double bound = 0.0;
  while (const Estimate* estimate = runtime.next_due(1'500'000'000)) {
    bound = runtime.bound(*estimate).value;
    EXPECT_EQ(estimate->stamp <= 1'050'000'000, std::isinf(bound)) << estimate->stamp;
  }
  EXPECT_TRUE(std::isfinite(bound));  // of 1.45 s
  EXPECT_FALSE(jump(1'500'000'001, 1'501'000'000).came_after_bound);
  EXPECT_TRUE(jump(1'500'000'000, 1'501'000'000).came_after_bound);
}

TEST(LostJumpsRuntimeTest, WhatIsPublishedDoesNotDependOnWhenANumberTellsOfALostJump) {
  const ObserverConfig config =
      test::CertifiedGains("config/examples/bernard2022_impulsive/gains.yaml")
          .with("rate: 100")
          .assuming("{initial_error: 1, noise: 0}")
          .config();
  for (const bool is_late : {false, true}) {
    ObserverRuntime runtime(config);
    const auto jump = [&](Stamp stamp, std::uint32_t index) {
      const double y = 0.0;
      Event event{stamp, EventKind::kJump, 0, &y, 1};
      event.index = index;
      return runtime.receive(event, stamp);
    };
    double published = 0.0;
    const auto publish = [&](Stamp now) {
      while (const Estimate* estimate = runtime.next_due(now)) {
        if (estimate->stamp <= 1'500'000'000) published = runtime.bound(*estimate).value;
      }
    };
    jump(1'000'000'000, 3);
    publish(is_late ? 1'400'000'000 : 1'501'000'000);
    EXPECT_TRUE(jump(1'502'000'000, 5).came_after_bound);
    publish(1'503'000'000);
    EXPECT_TRUE(std::isfinite(published)) << is_late;
    EXPECT_FALSE(jump(1'600'000'000, 6).came_after_bound);
    // Who asks later is told more.
    EstimateQuery query;
    ASSERT_EQ(nullptr, runtime.begin_query(1'500'000'000, 1'600'000'000, query));
    while (!query.proceed(1000)) {
    }
    EXPECT_EQ(BoundLoss::kUnknownJump, query.bound().loss);
  }
}

}  // namespace
}  // namespace sampled_data_observers
