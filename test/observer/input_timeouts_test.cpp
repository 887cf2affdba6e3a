// Inputs that are older than their timeout.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "sampled_data_observers/observer/plant_observer.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"
#include "support/stamps.h"
#include "support/type_examples.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

constexpr Duration kTimeout = 3 * kSecond / 10;

const char kLinear[] = R"(
observer: ConstantGainObserver
plant: {states: [p, v], inputs: [u, w], A: [[0, 1], [-2, -0.1]], B: [[0, 0.1], [1, 0.2]]}
sensors: {s: {C: [[1, 0]], source: {topic: s}}}
inputs:
  u: {topic: u, timeout: 0.3, after_timeout: {u: -0.5}}
  w: {topic: w}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[0.5], [0.2]]}
)";

bool are_same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

Estimate at(const Estimator& estimator, Stamp stamp) {
  Estimate estimate = estimator.make_estimate();
  EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(stamp, estimate));
  return estimate;
}

double first_input(const Estimate& estimate) {
  return *estimate.law->observer().held_part(estimate.state.data());
}

bool is_stale(const Estimate& estimate) {
  return estimate.law->observer().is_input_stale(estimate.state.data());
}

void take(Estimator& estimator, const OwnedEvent& event) {
  EXPECT_TRUE(estimator.submit(event.view(), kStart + 100 * kSecond).used());
}

TEST(InputTimeoutsTest, AfterTheTimeoutTheInputIsWhatIsStatedAsIfAMessageHadSaidSo) {
  const ObserverConfig config = test::parse(kLinear);
  Estimator silent(config.law, config.options);
  Estimator told(config.law, config.options);
  for (Estimator* estimator : {&silent, &told}) {
    take(*estimator, {kStart, EventKind::kInput, 0, {2.0}});
    take(*estimator, {kStart, EventKind::kInput, 1, {1.0}});
    take(*estimator, {kStart + kSecond, EventKind::kInput, 0, {3.0}});
  }
  take(told, {kStart + kTimeout, EventKind::kInput, 0, {-0.5}});
  take(told, {kStart + 2 * kTimeout, EventKind::kInput, 0, {-0.5}});
  take(told, {kStart + 3 * kTimeout, EventKind::kInput, 0, {-0.5}});
  EXPECT_EQ(2.0, first_input(at(silent, kStart + kTimeout - 1)));
  EXPECT_EQ(-0.5, first_input(at(silent, kStart + kTimeout)));
  EXPECT_EQ(3.0, first_input(at(silent, kStart + kSecond)));
  for (const Duration after : {kTimeout - 1, kTimeout, kTimeout + 1, kSecond, 5 * kSecond / 4}) {
    EXPECT_TRUE(at(silent, kStart + after)
                    .state.head(2)
                    .isApprox(at(told, kStart + after).state.head(2), 1e-14))
        << after;
  }
  EXPECT_FALSE(is_stale(at(silent, kStart + kTimeout - 1)));
  EXPECT_TRUE(is_stale(at(silent, kStart + kTimeout)));
  EXPECT_FALSE(is_stale(at(silent, kStart + kSecond)));
}

TEST(InputTimeoutsTest, WithoutAValueAfterItTheInputHoldsAndIsStale) {
  const ObserverConfig config =
      test::parse(test::replaced(kLinear, ", after_timeout: {u: -0.5}", ""));
  const ObserverConfig without =
      test::parse(test::replaced(kLinear, ", timeout: 0.3, after_timeout: {u: -0.5}", ""));
  Estimator estimator(config.law, config.options);
  Estimator holding(without.law, without.options);
  for (Estimator* each : {&estimator, &holding}) {
    take(*each, {kStart, EventKind::kInput, 0, {2.0}});
  }
  const Estimate late = at(estimator, kStart + kSecond);
  EXPECT_TRUE(is_stale(late));
  EXPECT_EQ(2.0, first_input(late));
  const Estimate held = at(holding, kStart + kSecond);
  EXPECT_FALSE(is_stale(held));
  EXPECT_TRUE(are_same_bits(held.state.head(2), late.state.head(2)));
}

TEST(InputTimeoutsTest, AnInputThatNeverCameIsAsOldAsTheEstimate) {
  const ObserverConfig config = test::parse(kLinear);
  Estimator estimator(config.law, config.options);
  take(estimator, {kStart, EventKind::kSample, 0, {1.0}});
  EXPECT_EQ(0.0, first_input(at(estimator, kStart + kTimeout - 1)));
  EXPECT_EQ(-0.5, first_input(at(estimator, kStart + kTimeout)));
}

TEST(InputTimeoutsTest, AStartGoesOnWithTheAgeOfTheInput) {
  const ObserverConfig config = test::parse(kLinear);
  Estimator estimator(config.law, config.options);
  take(estimator, {kStart, EventKind::kInput, 0, {2.0}});
  estimator.restart(kStart + kSecond / 5);
  EXPECT_EQ(2.0, first_input(at(estimator, kStart + kTimeout - 1)));
  EXPECT_EQ(-0.5, first_input(at(estimator, kStart + kTimeout)));
}

TEST(InputTimeoutsTest, AHeldStateLetsInputsAgeToo) {
  const ObserverConfig config = test::parse(kLinear);
  Eigen::VectorXd state(config.law->state_size());
  Eigen::VectorXd workspace(config.law->workspace_size());
  config.law->initialize(state.data());
  config.law->hold(kSecond, state.data());
  EXPECT_TRUE(config.law->observer().is_input_stale(state.data()));
  const OwnedEvent other{kStart, EventKind::kInput, 1, {1.0}};
  config.law->reset(other.view(), state.data(), workspace.data());
  EXPECT_EQ(-0.5, *config.law->observer().held_part(state.data()));
}

TEST(InputTimeoutsTest, HoweverAFlowIsSplitAtWholeStepsItGivesTheSameBits) {
  const ObserverConfig config = test::read_example("constant_gain_timeouts");
  const ObserverLaw& law = *config.law;
  const Duration step = law.flow_step();
  ASSERT_GT(step, 0);
  Eigen::VectorXd start(law.state_size());
  Eigen::VectorXd workspace(law.workspace_size());
  law.initialize(start.data());
  for (int channel = 0; channel < 2; ++channel) {
    const OwnedEvent input{kStart, EventKind::kInput, channel, {3.0}};
    law.reset(input.view(), start.data(), workspace.data());
    law.flow(step / 3, start.data(), workspace.data());
  }
  const Duration whole = 12 * step;
  const Duration rest = step / 7;
  Eigen::VectorXd once = start;
  law.flow(whole, once.data(), workspace.data());
  law.flow(rest, once.data(), workspace.data());
  EXPECT_EQ(0.4, law.observer().held_part(once.data())[1]);
  std::mt19937_64 generator(1);
  std::uniform_int_distribution<Duration> steps(1, 5);
  const std::size_t before = test::allocations();
  for (int i = 0; i < 50; ++i) {
    Eigen::VectorXd parts = start;
    for (Duration left = whole; left > 0;) {
      const Duration part = std::min(left, steps(generator) * step);
      law.flow(part, parts.data(), workspace.data());
      left -= part;
    }
    law.flow(rest, parts.data(), workspace.data());
    EXPECT_TRUE(are_same_bits(once, parts)) << i;
  }
  if (test::allocations_are_counted()) {
    EXPECT_EQ(before + 50, test::allocations());  // one for each copy
  }
}

TEST(InputTimeoutsTest, FaultsSayWhatIsExpected) {
  const std::vector<test::Fault> faults = {
      {"timeout: 0.3", "timeout: 0", {"inputs/u/timeout", "0"}},
      {"timeout: 0.3, ", "", {"inputs/u/after_timeout: expected the key timeout beside it"}},
      {"{u: -0.5}", "{w: -0.5}", {"inputs/u/after_timeout/u"}},
      {"{u: -0.5}", "{u: -0.5, w: 1}", {"inputs/u/after_timeout/w", "unknown key"}},
      {"{topic: w}", "{topic: w, time_out: 1}", {"inputs/w/time_out", "unknown key"}},
      {"source: {topic: s}", "source: {topic: s, timeout: 1}", {"source/timeout", "unknown key"}},
  };
  for (const test::Fault& change : faults) {
    const std::string message = test::fault(test::replaced(kLinear, change.from, change.to));
    EXPECT_EQ("", test::missing_parts(change, message)) << message;
  }
}

TEST(InputTimeoutsTest, TheOneTopicFormHasThemToo) {
  const ObserverConfig config = test::parse(test::replaced(
      kLinear,
      "inputs:\n  u: {topic: u, timeout: 0.3, after_timeout: {u: -0.5}}\n  w: {topic: w}\n",
      "input: {timeout: 0.3, after_timeout: {w: 1, u: 2}}\n"));
  const InputChannel& channel = config.plant->input_channels().at(0);
  EXPECT_EQ("input", channel.name);
  EXPECT_EQ(kTimeout, channel.timeout);
  EXPECT_EQ((std::vector<double>{2.0, 1.0}), channel.after_timeout);
}

}  // namespace
}  // namespace sampled_data_observers
