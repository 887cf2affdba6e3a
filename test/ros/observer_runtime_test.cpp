// Estimates at once after events, switching off and on, restarts and other gains.
#include "sampled_data_observers/ros/observer_runtime.h"

#include <gtest/gtest.h>

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
    return runtime_->receive(from, {stamp, from.kind, from.channel, &value, 1}, stamp, status_)
        .outcome;
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
  EventStatus status_;
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
  EXPECT_EQ(EventStatus::DISABLED, status_.outcome);
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
  next->take_over(*runtime_, 1'100'000'000);
  runtime_ = std::move(next);
  EXPECT_NEAR(before, position(1'100'000'000), 1e-12);
  EXPECT_NEAR(later, position(1'200'000'000), 1e-12);
  EXPECT_EQ((Stamps{1'100'000'000, 1'110'000'000}), due(1'110'000'000));
  EXPECT_EQ(EventOutcome::kDisabled, receive(1, 1'150'000'000, 2.0));
  EXPECT_EQ(EventOutcome::kUsed, receive(0, 1'200'000'000, later + 1.0));
  EXPECT_NEAR(later + 0.5, position(1'200'000'000), 1e-12);
}

}  // namespace
}  // namespace sampled_data_observers
