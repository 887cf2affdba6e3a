// A bound beside an estimate: driven by the same events, a function of them, and lost where what it
// rests on does not hold.
#include "sampled_data_observers/certificate/guaranteed_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "certificate/certified_gains.h"
#include "sampled_data_observers/observer/gated_samples.h"
#include "support/allocation_counter.h"
#include "support/law_runner.h"
#include "support/random_events.h"
#include "support/type_examples.h"

namespace sampled_data_observers::test {
namespace {

constexpr Stamp kStart = 1'600'000'000'000'000'000;
constexpr Duration kSecond = kNanosecondsPerSecond;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Grows by `rate` a second, halves at samples, doubles at jumps; infinite after `longest` seconds.
class ExampleBound : public ErrorBound {
 public:
  explicit ExampleBound(double longest = kInfinity, double rate = 1.0)
      : longest_(longest), rate_(rate) {}
  Eigen::Index state_size() const override { return 2; }
  void initialize(double* state) const override {
    state[0] = 8.0;
    state[1] = 0.0;
  }
  void flow(double duration, double* state) const override {
    state[0] += rate_ * duration;
    state[1] = duration;
    if (duration > longest_) state[0] = kInfinity;
  }
  void sample(double* state, double*) const override { state[0] /= 2.0; }
  void jump(double* state) const override { state[0] *= 2.0; }
  double bound(const double* state) const override { return state[0]; }

 private:
  double longest_;
  double rate_;
};

std::shared_ptr<const GuaranteedBound> bounded(const std::shared_ptr<const ObserverLaw>& law,
                                               double longest = kInfinity,
                                               double error_limit = kInfinity) {
  return std::make_shared<const GuaranteedBound>(law, std::make_unique<ExampleBound>(longest),
                                                 error_limit);
}

std::shared_ptr<const GuaranteedBound> bounded_example(const std::string& type) {
  return bounded(read_example(type).law);
}

TEST(GuaranteedBoundTest, AGatedSampleDoesNotShortenItAndARecoveryByResetLosesIt) {
  std::vector<std::optional<Gate>> gates(2);
  Gate& gate = gates[0].emplace();
  gate.innovation = Eigen::VectorXd::Constant(1, 1.0);
  gate.recover_after = 2 * kSecond;
  gate.recovery = Gate::Recovery::kReset;
  const auto law = std::make_shared<const GatedSamples>(bounded(example_law()), gates);
  LawRunner runner(law);
  const auto bound = [&] { return law->error_bound(runner.state().data()); };
  EXPECT_TRUE(runner.sample(0, {runner.estimate()(0)}));
  EXPECT_EQ(4.0, bound());
  runner.flow(kSecond);
  EXPECT_FALSE(runner.sample(0, {9.0}));
  EXPECT_EQ(5.0, bound());
  runner.flow(2 * kSecond);
  EXPECT_EQ(7.0, bound());
  EXPECT_TRUE(runner.sample(0, {9.0}));
  EXPECT_EQ(kInfinity, bound());
}

TEST(GuaranteedBoundTest, FollowsFlowSamplesAndJumps) {
  const auto law = bounded(example_law());
  LawRunner runner(law);
  const auto bound = [&] { return law->error_bound(runner.state().data()); };
  EXPECT_EQ(8.0, bound());
  runner.flow(2 * kSecond);
  EXPECT_EQ(10.0, bound());
  runner.input({0.0, 0.0});
  EXPECT_EQ(10.0, bound());
  runner.sample(0, {0.0});
  EXPECT_EQ(5.0, bound());
  runner.flow(3 * kSecond);
  runner.jump();
  EXPECT_EQ(16.0, bound());
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
  EXPECT_EQ(3.5, bound_at(2.0));
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
  EXPECT_EQ(8.5, bound_at(5.5));
  estimator.restart(kStart + 6 * kSecond, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(8.25, bound_at(6.25));
}

TEST(GuaranteedBoundTest, TooLargeABoundIsNoneButTheEstimateGoesOn) {
  const auto law = std::make_shared<const GuaranteedBound>(
      example_law(), std::make_unique<ExampleBound>(kInfinity, 1e101), kInfinity);
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
  const auto law = bounded(config.law);
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
  EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + 1000 * kSecond, estimate));
  EXPECT_EQ(kInfinity, law->error_bound(estimate.state.data()));
}

TEST(GuaranteedBoundTest, IsLostAfterAJumpWhoseOutputsDoNotCome) {
  const auto law = bounded_example("synchronized");
  ASSERT_GE(law->event_size(EventKind::kJump, kMeasuredJump), 0);
  int sensor = 0;
  while (law->event_size(EventKind::kJumpOutput, sensor) < 0) ++sensor;
  const std::vector<double> y_d(
      static_cast<std::size_t>(law->event_size(EventKind::kJumpOutput, sensor)), 0.1);
  LawRunner runner(law);
  const auto bound = [&] { return law->error_bound(runner.state().data()); };
  runner.flow(kSecond);
  runner.jump();
  EXPECT_EQ(kInfinity, bound());
  runner.jump_output(sensor, y_d);
  EXPECT_EQ(18.0, bound());
  runner.flow(kSecond);
  runner.jump(std::vector<double>(
      static_cast<std::size_t>(law->event_size(EventKind::kJump, kMeasuredJump)), 0.1));
  EXPECT_EQ(38.0, bound());
  runner.flow(kSecond);
  runner.jump();
  EXPECT_EQ(kInfinity, bound());
  runner.flow(1);
  runner.jump_output(sensor, y_d);
  EXPECT_EQ(kInfinity, bound());
}

TEST(GuaranteedBoundTest, IsLostWhereAnAngleMayHaveBeenWrapped) {
  const auto law = bounded(example_law(), kInfinity, 9.0);
  LawRunner runner(law);
  runner.flow(kSecond);
  runner.sample(0, {0.0});
  EXPECT_EQ(4.5, law->error_bound(runner.state().data()));
  runner.flow(5 * kSecond);
  EXPECT_EQ(9.5, law->error_bound(runner.state().data()));
  runner.sample(0, {0.0});
  EXPECT_EQ(kInfinity, law->error_bound(runner.state().data()));
}

/// The bounds at many stamps.
std::vector<double> bounds(const Estimator& estimator) {
  std::vector<double> result;
  Estimate estimate = estimator.make_estimate();
  for (Stamp stamp = kStart; stamp < kStart + 3 * kSecond; stamp += 37'000'123) {
    const Timeline::Query query = estimator.estimate_at(stamp, estimate);
    if (query != Timeline::Query::kOk && query != Timeline::Query::kHeld) continue;
    result.push_back(estimator.law().error_bound(estimate.state.data()));
    result.insert(result.end(), estimate.state.data(),
                  estimate.state.data() + estimate.state.size());
  }
  return result;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Every observer type with the example's bound, and the real one of a theorem.
std::vector<std::shared_ptr<const ObserverLaw>> bounded_laws() {
  std::vector<std::shared_ptr<const ObserverLaw>> laws;
  for (const std::string& type : type_examples()) {
    const auto law = read_example(type).law;
    if (!law->delays_jumps()) laws.push_back(bounded(law, 0.4));
  }
  laws.push_back(CertifiedGains("test/certificate/ferrante2019_oscillator_0.2.yaml")
                     .assuming("{initial_error: 1, noise: 0.1, disturbance: 0.5}")
                     .config()
                     .law);
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
    const std::size_t before = allocations();
    for (const OwnedEvent& event : events) {
      estimator.submit(event.view(), kStart + 50 * kSecond);
      estimator.estimate_at(event.stamp + kSecond / 7, estimate);
      sum += law->error_bound(estimate.state.data());
    }
    estimator.restart(kStart + 6 * kSecond);
    EXPECT_EQ(before, allocations());
    EXPECT_GT(sum, 0.0);
  }
}

}  // namespace
}  // namespace sampled_data_observers::test
