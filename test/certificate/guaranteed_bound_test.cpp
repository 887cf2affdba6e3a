// A bound beside an estimate: driven by the same events, a function of them, and lost where what it
// rests on does not hold.
#include "certificate/guaranteed_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "certificate/certified_gains.h"
#include "certificate/state_shares.h"
#include "observer/gated_measurements.h"
#include "observer/limited_jumps.h"
#include "support/allocation_counter.h"
#include "support/law_runner.h"
#include "support/random_events.h"
#include "support/stamps.h"
#include "support/type_examples.h"

namespace sampled_data_observers::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// What is added for it is less.
constexpr double kRounding = 1e-11;

/// Grows by `rate` a second, halves at samples, doubles at jumps, triples at those that nothing
/// corrects; infinite after `longest` seconds.
class ExampleBound : public ErrorBound {
 public:
  explicit ExampleBound(double longest = kInfinity, double rate = 1.0, bool injects = false)
      : longest_(longest), rate_(rate), injects_(injects) {}
  Eigen::Index state_size() const override { return 2; }
  void initialize(double* state) const override { begin(8.0, state); }
  void begin(double error, double* state) const override {
    state[0] = error;
    state[1] = 0.0;
  }
  void flow(double duration, double* state) const override {
    state[0] += rate_ * duration;
    state[1] = duration;
    if (duration > longest_) state[0] = kInfinity;
  }
  void sample(std::size_t, double* state, double*) const override { state[0] /= 2.0; }
  bool injects_between_samples() const override { return injects_; }
  void jump(const JumpMotion&, double* state) const override { state[0] *= 2.0; }
  void uncorrected_jump(const JumpMotion&, double* state) const override { state[0] *= 3.0; }
  void refused_jump(const JumpMotion& motion, double* state) const override {
    state[0] += motion.moved;
  }
  double bound(const double* state) const override { return state[0]; }

 private:
  double longest_;
  double rate_;
  bool injects_;
};

/// @param law  of example_plant()
std::shared_ptr<const GuaranteedBound> bounded(const std::shared_ptr<const ObserverLaw>& law,
                                               double longest = kInfinity) {
  return std::make_shared<const GuaranteedBound>(law, std::make_unique<ExampleBound>(longest),
                                                 example_plant(), 0.0);
}

std::shared_ptr<const GuaranteedBound> bounded(const ObserverConfig& config,
                                               double longest = kInfinity) {
  return std::make_shared<const GuaranteedBound>(
      config.law, std::make_unique<ExampleBound>(longest), config.plant, 0.0);
}

TEST(GuaranteedBoundTest, AGatedSampleDoesNotShortenItAndARecoveryByResetLosesIt) {
  std::vector<std::optional<Gate>> gates(2);
  Gate& gate = gates[0].emplace();
  gate.innovation = Eigen::VectorXd::Constant(1, 1.0);
  gate.recover_after = 2 * kSecond;
  gate.recovery = Gate::Recovery::kReset;
  const auto law = std::make_shared<const GatedMeasurements>(bounded(example_law()), gates);
  LawRunner runner(law);
  const auto bound = [&] { return law->error_bound(runner.state().data()); };
  EXPECT_TRUE(runner.sample(0, {runner.estimate()(0)}));
  EXPECT_NEAR(4.0, bound(), kRounding);
  runner.flow(kSecond);
  EXPECT_FALSE(runner.sample(0, {9.0}));
  EXPECT_NEAR(5.0, bound(), kRounding);
  runner.flow(2 * kSecond);
  EXPECT_NEAR(7.0, bound(), kRounding);
  EXPECT_TRUE(runner.sample(0, {9.0}));
  EXPECT_EQ(kInfinity, bound());
}

TEST(GuaranteedBoundTest, FollowsFlowSamplesAndJumps) {
  const auto law = bounded(example_law());
  LawRunner runner(law);
  const auto bound = [&] { return law->error_bound(runner.state().data()); };
  EXPECT_NEAR(8.0, bound(), kRounding);
  runner.flow(2 * kSecond);
  EXPECT_NEAR(10.0, bound(), kRounding);
  runner.input({0.0, 0.0});
  EXPECT_NEAR(10.0, bound(), kRounding);
  runner.sample(0, {0.0});
  EXPECT_NEAR(5.0, bound(), kRounding);
  runner.flow(3 * kSecond);
  runner.jump();
  EXPECT_NEAR(16.0, bound(), kRounding);
}

TEST(GuaranteedBoundTest, LeavesTheLawAsItIs) {
  const auto inner = example_law();
  LawRunner plain(inner);
  LawRunner bounded_runner(bounded(inner));
  for (LawRunner* runner : {&plain, &bounded_runner}) {
    runner->flow(kSecond / 3);
    runner->sample(1, {0.3, -0.2});
    runner->jump();
    runner->flow(kSecond / 7);
  }
  EXPECT_EQ(plain.estimate(), bounded_runner.estimate());
}

TEST(GuaranteedBoundTest, ComparesDurationsWithBoundsAsTheyAreWritten) {
  for (const double T2 : {0.41, 0.1, 0.3, 0.7, 1e-3}) {
    const auto law = bounded(example_law(), T2);
    LawRunner runner(law);
    runner.flow(from_seconds(T2));
    EXPECT_TRUE(std::isfinite(law->error_bound(runner.state().data()))) << T2;
    runner.flow(1);
    EXPECT_EQ(kInfinity, law->error_bound(runner.state().data())) << T2;
  }
}

TEST(GuaranteedBoundTest, OnceLostItIsLostUntilTheNextStart) {
  const auto law = bounded(example_law(), 1.0);
  Estimator::Options options;
  options.history = {100 * kSecond, 100};
  options.sampling = {1, kSecond};
  Estimator estimator(law, options);
  Estimate estimate = estimator.make_estimate();
  const auto bound_at = [&](double seconds) {
    EXPECT_EQ(Timeline::Query::kOk,
              estimator.estimate_at(kStart + from_seconds(seconds), estimate));
    return law->error_bound(estimate.state.data());
  };
  const auto sample = [&](double seconds) {
    const double y = 0.1;
    const Stamp stamp = kStart + from_seconds(seconds);
    EXPECT_TRUE(
        estimator.submit({stamp, EventKind::kSample, 0, &y, 1}, kStart + 50 * kSecond).used());
  };
  sample(0.0);
  sample(1.0);
  EXPECT_NEAR(3.5, bound_at(2.0), kRounding);
  EXPECT_EQ(kInfinity, bound_at(2.001));
  sample(2.5);
  EXPECT_EQ(kInfinity, bound_at(2.6));
  sample(2.9);
  EXPECT_EQ(kInfinity, bound_at(3.0));
  // A sample that was on its way fills the gap.
  sample(1.6);
  EXPECT_TRUE(std::isfinite(bound_at(3.0)));
  sample(4.5);
  EXPECT_EQ(kInfinity, bound_at(4.5));
  estimator.restart(kStart + 5 * kSecond);
  EXPECT_NEAR(8.5, bound_at(5.5), kRounding);
  estimator.restart(kStart + 6 * kSecond, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR(8.25, bound_at(6.25), kRounding);
}

TEST(GuaranteedBoundTest, TooLargeABoundIsNoneButTheEstimateGoesOn) {
  const auto law = std::make_shared<const GuaranteedBound>(
      example_law(), std::make_unique<ExampleBound>(kInfinity, 1e101), example_plant(), 0.0);
  LawRunner runner(law);
  runner.flow(kSecond);
  EXPECT_EQ(kInfinity, law->error_bound(runner.state().data()));
  EXPECT_LT(runner.state().cwiseAbs().maxCoeff(), 1e100);
}

TEST(GuaranteedBoundTest, IsLostWhereTheEstimateIsHeld) {
  // ẋ = x: after 400 s no double holds it.
  const auto config = read_observer_config(read_yaml_text(R"(
observer: ConstantGainObserver
plant: {states: [p], A: [[1]]}
sensors: {position: {C: [[1]], source: {topic: position}}}
sampling: {T1: 0.1, T2: 0.2}
gains: {L: [[0.5]]}
initial_estimate: {p: 1}
)",
                                                          "unstable.yaml"),
                                           no_plant_plugins);
  const auto law = bounded(config);
  Estimator::Options options;
  options.history = {2000 * kSecond, 100};
  options.sampling = {1, kSecond};
  options.future_tolerance = 2000 * kSecond;
  Estimator estimator(law, options);
  Estimate estimate = estimator.make_estimate();
  const auto sample = [&](Stamp stamp) {
    const double y = 0.1;
    EXPECT_TRUE(estimator.submit({stamp, EventKind::kSample, 0, &y, 1}, stamp).used());
  };
  sample(kStart);
  EXPECT_EQ(Timeline::Query::kHeld, estimator.estimate_at(kStart + 900 * kSecond, estimate));
  EXPECT_EQ(kInfinity, law->error_bound(estimate.state.data()));
  sample(kStart + 1000 * kSecond);
  EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + 1000 * kSecond + 1, estimate));
  EXPECT_EQ(kInfinity, law->error_bound(estimate.state.data()));
}

TEST(GuaranteedBoundTest, GrowsAtAJumpWhoseOutputsDoNotCome) {
  const auto law = bounded(read_example("synchronized"));
  const PlantObserver& observer = law->observer();
  const Eigen::Index outputs = observer.event_size(EventKind::kJump);
  ASSERT_GT(outputs, 0);
  const std::vector<double> all_outputs(static_cast<std::size_t>(outputs), 0.1);
  std::size_t measured = 0;
  while (observer.event_size(EventKind::kJumpOutput, measured) < 0) ++measured;
  const auto sensor = static_cast<int>(measured);
  const std::vector<double> y_d(
      static_cast<std::size_t>(observer.event_size(EventKind::kJumpOutput, measured)), 0.1);
  LawRunner runner(law);
  const auto bound = [&] { return law->error_bound(runner.state().data()); };
  runner.flow(kSecond);
  runner.jump();
  EXPECT_NEAR(27.0, bound(), kRounding);
  runner.jump_output(sensor, y_d);
  EXPECT_NEAR(18.0, bound(), kRounding);
  runner.flow(kSecond);
  runner.jump(all_outputs);
  EXPECT_NEAR(38.0, bound(), kRounding);
  runner.flow(kSecond);
  runner.jump();
  runner.flow(kSecond / 2);
  EXPECT_NEAR(117.5, bound(), kRounding);
  // Too late for that jump.
  runner.jump_output(sensor, y_d);
  runner.flow(kSecond / 2);
  EXPECT_NEAR(118.0, bound(), kRounding);
  runner.jump(all_outputs);
  EXPECT_NEAR(236.0, bound(), kRounding);
}

Estimator::Options long_history() {
  Estimator::Options options;
  options.history = {100 * kSecond, 500};
  options.sampling = {1, kSecond};
  return options;
}

/// An estimator with an example's bound, and its bound at some time of a run.
class BoundedRun {
 public:
  explicit BoundedRun(std::shared_ptr<const ObserverLaw> law,
                      const Estimator::Options& options = long_history())
      : estimator_(std::move(law), options), estimate_(estimator_.make_estimate()) {}

  EventReport submit(EventKind kind, double seconds, const std::vector<double>& values,
                     double now = 50.0) {
    return estimator_.submit({kStart + from_seconds(seconds), kind, 0, values.data(),
                              static_cast<Eigen::Index>(values.size())},
                             kStart + from_seconds(now));
  }
  PublishedBound at(double seconds, double now = 50.0) {
    EXPECT_EQ(Timeline::Query::kOk,
              estimator_.estimate_at(kStart + from_seconds(seconds), estimate_));
    return estimator_.bound(estimate_, kStart + from_seconds(now));
  }
  BoundLoss loss_at(double seconds) {
    const PublishedBound bound = at(seconds);
    EXPECT_EQ(bound.loss != BoundLoss::kNone, std::isinf(bound.value)) << seconds;
    return bound.loss;
  }
  Estimator& estimator() { return estimator_; }
  const Eigen::VectorXd& estimate() const { return estimate_.state; }

 private:
  Estimator estimator_;
  Estimate estimate_;
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(GuaranteedBoundTest, IsLostWhereAnInputOrJumpIsRejectedButNotWhereASampleIs) {
  BoundedRun run(bounded(example_law()));
  EXPECT_TRUE(run.submit(EventKind::kSample, 1.0, {0.1}).used());
  EXPECT_TRUE(run.submit(EventKind::kInput, 1.5, {0.1, 0.2}).used());
  EXPECT_EQ(EventOutcome::kNotFinite, run.submit(EventKind::kSample, 2.0, {kNan}).outcome);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(10.0));
  EXPECT_EQ(EventOutcome::kNotFinite, run.submit(EventKind::kInput, 3.0, {0.1, kNan}).outcome);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(2.9));
  EXPECT_EQ(BoundLoss::kUnknownInput, run.loss_at(3.0));
  EXPECT_TRUE(run.submit(EventKind::kInput, 4.0, {0.1, 0.2}).used());
  EXPECT_EQ(BoundLoss::kUnknownInput, run.loss_at(5.0));
  // Nobody vouches for the past, and the input is known again.
  run.estimator().restart(kStart + 6 * kSecond);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(7.0));
  EXPECT_EQ(EventOutcome::kWrongSize, run.submit(EventKind::kJump, 8.0, {1.0}).outcome);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(7.9));
  EXPECT_EQ(BoundLoss::kUnknownJump, run.loss_at(8.0));
}

TEST(GuaranteedBoundTest, IsLostWhereAnInputIsOlderThanItsTimeout) {
  const ObserverConfig config = read_example("constant_gain_timeouts");
  BoundedRun run(bounded(config));
  for (int i = 0; i <= 20; ++i) {
    run.submit(EventKind::kInput, 1.0 + 0.05 * i, {0.1});
    Event wind;
    const double value = 0.2;
    wind.kind = EventKind::kInput;
    wind.stamp = kStart + from_seconds(1.0 + 0.05 * i);
    wind.sensor = 1;
    wind.values = &value;
    wind.size = 1;
    run.estimator().submit(wind, kStart + 50 * kSecond);
  }
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(2.07));
  EXPECT_EQ(BoundLoss::kUnknownInput, run.loss_at(2.08));
}

TEST(GuaranteedBoundTest, IsLostByInputsOfTheFutureFromWhenTheyCome) {
  BoundedRun run(bounded(example_law()));
  EXPECT_TRUE(run.submit(EventKind::kSample, 1.0, {0.1}, 1.0).used());
  EXPECT_EQ(EventOutcome::kInFuture, run.submit(EventKind::kInput, 9.0, {0.1, 0.1}, 2.0).outcome);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(1.9));
  EXPECT_EQ(BoundLoss::kUnknownInput, run.loss_at(2.0));
  // A start does not help while the input is not known.
  run.estimator().restart(kStart + 3 * kSecond);
  EXPECT_EQ(BoundLoss::kUnknownInput, run.loss_at(3.1));
  EXPECT_TRUE(run.submit(EventKind::kInput, 4.0, {0.1, 0.1}).used());
  run.estimator().restart(kStart + 5 * kSecond);
  EXPECT_EQ(BoundLoss::kNone, run.loss_at(5.1));
}

TEST(GuaranteedBoundTest, IsLostFromTheStartWhereTheFirstInputWasRejected) {
  BoundedRun run(bounded(example_law()));
  EXPECT_EQ(EventOutcome::kNotFinite, run.submit(EventKind::kInput, 1.0, {kNan, 0.0}).outcome);
  EXPECT_TRUE(run.submit(EventKind::kSample, 2.0, {0.1}).used());
  EXPECT_EQ(BoundLoss::kUnknownInput, run.loss_at(2.0));
}

TEST(GuaranteedBoundTest, IsLostByInputsAndJumpsThatComeTooLateButNotByJumpsBeforeAReset) {
  Estimator::Options options = long_history();
  options.history.history = 2 * kSecond;
  for (const EventKind kind : {EventKind::kInput, EventKind::kJump}) {
    const bool is_input = kind == EventKind::kInput;
    const std::vector<double> values(is_input ? 2 : 0, 0.1);
    BoundedRun run(bounded(example_law()), options);
    for (int i = 0; i <= 6; ++i) run.submit(EventKind::kSample, i, {0.1});
    EXPECT_EQ(EventOutcome::kTooOld, run.submit(kind, 1.5, values).outcome);
    EXPECT_EQ(is_input ? BoundLoss::kUnknownInput : BoundLoss::kUnknownJump, run.loss_at(6.0));
    if (is_input) {
      EXPECT_TRUE(run.submit(kind, 6.1, values).used());
    }
    run.estimator().restart(kStart + 7 * kSecond);
    EXPECT_EQ(BoundLoss::kNone, run.loss_at(7.5));
    EXPECT_EQ(EventOutcome::kTooOld, run.submit(kind, 6.5, values).outcome);
    EXPECT_EQ(is_input ? BoundLoss::kUnknownInput : BoundLoss::kNone, run.loss_at(7.5));
  }
}

TEST(GuaranteedBoundTest, IsToldHowFarTheEstimateWouldHaveMovedAtAJumpThatIsRefused) {
  BoundedRun run(
      bounded(std::make_shared<const LimitedJumps>(example_law(), JumpLimits{kSecond, 100.0})));
  EXPECT_TRUE(run.submit(EventKind::kJump, 1.0, {}).used());
  EXPECT_NEAR(16.5, run.at(1.5).value, kRounding);
  // x+ - x = (0, -1.8 v + 0.1, 0)
  const double moved = std::abs(-1.8 * run.estimate()(1) + 0.1);
  EXPECT_EQ(EventOutcome::kTooFrequent, run.submit(EventKind::kJump, 1.5, {}).outcome);
  EXPECT_NEAR(16.5 + moved, run.at(1.5).value, 1e-9);
  EXPECT_NEAR(17.5 + moved, run.at(2.5).value, 1e-9);
}

TEST(GuaranteedBoundTest, WaitsForWhatMayStillComeButNotForSamples) {
  Estimator::Options options = long_history();
  options.latency = kSecond / 10;
  BoundedRun run(bounded(example_law()), options);
  EXPECT_TRUE(run.submit(EventKind::kSample, 1.0, {0.1}).used());
  EXPECT_EQ(BoundLoss::kStillOnTheirWay, run.at(2.0, 2.0).loss);
  EXPECT_EQ(kInfinity, run.at(2.0, 2.09).value);
  EXPECT_EQ(BoundLoss::kNone, run.at(2.0, 2.1).loss);
  EXPECT_NEAR(5.0, run.at(2.0, 2.1).value, kRounding);

  const auto config = CertifiedGains("test/certificate/ferrante2019_oscillator_0.2.yaml")
                          .assuming("{initial_error: 1, noise: 0, disturbance: 0, latency: 0.1}")
                          .config();
  EXPECT_EQ(kSecond / 10, config.options.latency);
  BoundedRun sampled(config.law, config.options);
  EXPECT_TRUE(sampled.submit(EventKind::kSample, 1.0, {0.1}).used());
  EXPECT_TRUE(std::isfinite(sampled.at(1.1, 1.1).value));
}

TEST(GuaranteedBoundTest, IsNeverBelowTheRoundingOfTheEstimate) {
  const auto law = bounded(example_law());
  LawRunner runner(law);
  for (int i = 0; i < 200; ++i) runner.sample(0, {1e6});
  const double size = runner.estimate().norm();
  EXPECT_GT(size, 1e5);
  EXPECT_GT(law->error_bound(runner.state().data()), 1e-14 * size);
  EXPECT_LT(law->error_bound(runner.state().data()), 1e-12 * size);
}

TEST(GuaranteedBoundTest, IntervalsOfJumpsAreToldAndCheckedWhereThereAreNoSamples) {
  BoundedRun sampled(bounded(example_law()));
  EXPECT_FALSE(sampled.submit(EventKind::kJump, 1.0, {}).interval);
  const EventReport beside_samples = sampled.submit(EventKind::kJump, 3.0, {});
  EXPECT_EQ(2 * kSecond, beside_samples.interval);
  EXPECT_EQ(IntervalCheck::kNone, beside_samples.interval_check);

  const auto law = CertifiedGains("config/examples/bernard2022_impulsive/gains.yaml").config().law;
  Estimator::Options options = long_history();
  options.sampling = {2 * kSecond, 5 * kSecond};
  BoundedRun run(law, options);
  run.submit(EventKind::kJump, 1.0, {});
  EXPECT_EQ(IntervalCheck::kWithin, run.submit(EventKind::kJump, 3.0, {}).interval_check);
  EXPECT_EQ(IntervalCheck::kLong, run.submit(EventKind::kJump, 9.0, {}).interval_check);
  EXPECT_EQ(IntervalCheck::kShort, run.submit(EventKind::kJump, 10.0, {}).interval_check);
}

TEST(GuaranteedBoundTest, IsLostWhereAnAngleThatMayHaveTurnedOverIsInjectedUntilTheNextSample) {
  for (const bool injects : {false, true}) {
    const auto law = std::make_shared<const GuaranteedBound>(
        example_law(), std::make_unique<ExampleBound>(kInfinity, 1.0, injects), example_plant(),
        0.0);
    LawRunner runner(law);
    const Eigen::VectorXd before = runner.estimate();
    runner.sample(1, {0.0, 0.0});
    const double moved = (runner.estimate() - before).norm();
    const double bound = law->error_bound(runner.state().data());
    EXPECT_EQ(injects ? BoundLoss::kAngle : BoundLoss::kNone,
              law->bound_loss(runner.state().data()));
    if (injects) {
      EXPECT_EQ(kInfinity, bound);
    } else {
      EXPECT_NEAR(8.0 + moved, bound, kRounding);
    }
  }
}

/// The bounds at many stamps.
std::vector<double> bounds(const Estimator& estimator) {
  std::vector<double> result;
  Estimate estimate = estimator.make_estimate();
  for (Stamp stamp = kStart; stamp < kStart + 3 * kSecond; stamp += 37'000'123) {
    const Timeline::Query query = estimator.estimate_at(stamp, estimate);
    if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) continue;
    result.push_back(estimator.law().error_bound(estimate.state.data()));
    const Eigen::VectorXd of_states = StateShares(estimator.law()).bounds(estimate.state);
    result.insert(result.end(), of_states.data(), of_states.data() + of_states.size());
    result.insert(result.end(), estimate.state.data(),
                  estimate.state.data() + estimate.state.size());
  }
  return result;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Every observer type with the example's bound, and the real ones of some theorems.
std::vector<std::shared_ptr<const ObserverLaw>> bounded_laws() {
  std::vector<std::shared_ptr<const ObserverLaw>> laws;
  for (const std::string& type : type_examples()) {
    const ObserverConfig config = read_example(type);
    if (!config.law->delays_jumps()) laws.push_back(bounded(config, 0.4));
  }
  const auto add = [&laws](const char* gains, const char* assumptions) {
    laws.push_back(CertifiedGains(gains).assuming(assumptions).config().law);
  };
  add("test/certificate/ferrante2019_oscillator_0.2.yaml",
      "{initial_error: 1, noise: 0.1, disturbance: 0.5}");
  add("config/examples/ferrante2016_mass_spring/gains.yaml",
      "{initial_error: 1, noise: 0.1, disturbance: 0}");
  add("config/examples/sferlazza2019_aircraft_1_3/gains.yaml",
      "{initial_error: 1, noise: 0.1, disturbance: 0}");
  return laws;
}

TEST(GuaranteedBoundTest, EveryOrderOfArrivalAndAnyQueriesGiveTheSameBits) {
  Estimator::Options options;
  options.history = {100 * kSecond, 500};
  options.sampling = {1, kSecond};
  for (const auto& law : bounded_laws()) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      std::mt19937_64 generator(seed);
      std::vector<OwnedEvent> events = random_events_for(*law, generator, 30, kStart, 2 * kSecond);
      std::uniform_int_distribution<Stamp> any(kStart, kStart + 3 * kSecond);
      // Among them one that is rejected.
      const Eigen::Index inputs = law->observer().event_size(EventKind::kInput);
      if (inputs > 0 && seed % 2 == 0) {
        events.push_back({any(generator), EventKind::kInput, 0,
                          std::vector<double>(static_cast<std::size_t>(inputs), kNan)});
      }
      const auto expected = [&] {
        Estimator estimator(law, options);
        for (const OwnedEvent& event : events)
          estimator.submit(event.view(), kStart + 50 * kSecond);
        return bounds(estimator);
      }();
      for (int permutation = 0; permutation < 4; ++permutation) {
        std::shuffle(events.begin(), events.end(), generator);
        Estimator estimator(law, options);
        Estimate estimate = estimator.make_estimate();
        for (const OwnedEvent& event : events) {
          estimator.submit(event.view(), kStart + 50 * kSecond);
          for (int i = 0; i < 3; ++i) estimator.estimate_at(any(generator), estimate);
        }
        EXPECT_TRUE(same_bits(expected, bounds(estimator))) << "seed " << seed;
      }
    }
  }
}

/// Of each state the double, but half the bound of the first; of the last one something that is no
/// number.
class ExampleStateBound : public ExampleBound {
 public:
  using ExampleBound::ExampleBound;
  void state_bounds(const double* state, double*,
                    Eigen::Ref<Eigen::VectorXd> bounds) const override {
    bounds.setConstant(2.0 * bound(state));
    bounds(bounds.size() - 1) = kNan;
    bounds(0) = bound(state) / 2.0;
  }
  void ellipsoid(const double* state, double*, Eigen::Ref<Eigen::MatrixXd> Q) const override {
    set_to_ball(bound(state) / 2.0, Q);
    if (bound(state) > 9.0) Q(0, 0) = kNan;
  }
};

TEST(GuaranteedBoundTest, OfAStateIsTheSmallerOneAndInfiniteWhereThatOfTheNormIs) {
  const ObserverConfig config = read_example("constant_gain");
  const GuaranteedBound law(config.law, std::make_unique<ExampleStateBound>(2.0), config.plant,
                            0.0);
  StateShares shares(law);
  Eigen::VectorXd state(law.state_size());
  Eigen::VectorXd workspace(law.workspace_size());
  law.initialize(state.data());
  state(0) = 1e6;
  const Eigen::Index n = law.estimate_size();
  const double rounding = law.error_bound(state.data()) - 8.0;
  EXPECT_GT(rounding, 0.0);
  Eigen::VectorXd expected = Eigen::VectorXd::Constant(n, 8.0 + rounding);
  expected(0) = 4.0 + rounding;
  EXPECT_LT((shares.bounds(state) - expected).norm(), rounding / 100.0);
  Eigen::MatrixXd Q(n, n);
  law.error_ellipsoid(state.data(), workspace.data(), Q);
  EXPECT_GT(Q(0, 0), 16.0);
  EXPECT_LT((Q - 16.0 * Eigen::MatrixXd::Identity(n, n)).norm(), 1e-5);

  law.flow(3 * kSecond / 2, state.data(), workspace.data());
  law.error_ellipsoid(state.data(), workspace.data(), Q);
  EXPECT_NEAR(9.5 * 9.5, Q(0, 0), 1e-4);  // the ball where the ellipsoid is no set

  law.flow(kSecond, state.data(), workspace.data());
  EXPECT_EQ(kInfinity, law.error_bound(state.data()));
  EXPECT_EQ(kInfinity, shares.bounds(state).minCoeff());
  law.error_ellipsoid(state.data(), workspace.data(), Q);
  EXPECT_EQ(kInfinity, Q.diagonal().minCoeff());
  EXPECT_EQ(0.0, Q(0, 1));
}

TEST(GuaranteedBoundTest, NothingIsAllocatedForEventsAndQueries) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Estimator::Options options;
  options.history = {100 * kSecond, 500};
  options.sampling = {1, kSecond};
  for (const auto& law : bounded_laws()) {
    std::mt19937_64 generator(3);
    const auto events = random_events_for(*law, generator, 300, kStart, 5 * kSecond);
    Estimator estimator(law, options);
    Estimate estimate = estimator.make_estimate();
    double sum = 0.0;
    Eigen::VectorXd of_states(law->estimate_size());
    Eigen::MatrixXd Q(law->estimate_size(), law->estimate_size());
    const std::size_t before = allocations();
    for (const OwnedEvent& event : events) {
      estimator.submit(event.view(), kStart + 50 * kSecond);
      estimator.estimate_at(event.stamp + kSecond / 7, estimate);
      sum += law->error_bound(estimate.state.data());
      estimator.state_bounds(estimate, kStart + 50 * kSecond, of_states);
      estimator.error_ellipsoid(estimate, kStart + 50 * kSecond, Q);
      sum += of_states(0) + Q(0, 0);
    }
    estimator.restart(kStart + 6 * kSecond);
    EXPECT_EQ(before, allocations());
    EXPECT_GT(sum, 0.0);
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
