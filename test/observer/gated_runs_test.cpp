// Gates around every observer type, and in simulated runs with faulty sensors.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "observer/gated_measurements.h"
#include "support/allocation_counter.h"
#include "support/config_faults.h"
#include "support/stamps.h"
#include "support/type_examples.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;
using test::OwnedEvent;

class GatedTypeTest : public ::testing::TestWithParam<std::string> {
 protected:
  GatedTypeTest()
      : config_(test::read_example(GetParam())),
        law_(std::make_shared<const GatedMeasurements>(config_.law, test::narrow_gates(config_))) {
    config_.options.history = {100 * kSecond, 500};
  }

  Estimator make() const { return {law_, config_.options}; }

  static EventReport take(Estimator& estimator, const OwnedEvent& event) {
    Event view = event.view();
    if (event.kind == EventKind::kJump) view.release = event.stamp + kSecond / 20;
    return estimator.submit(view, kStart + 50 * kSecond);
  }

  static std::vector<double> history(const Estimator& estimator) {
    std::vector<double> result;
    Estimate estimate = estimator.make_estimate();
    for (Stamp stamp = kStart; stamp < kStart + 3 * kSecond; stamp += 57'000'123) {
      if (estimator.estimate_at(stamp, estimate) != Timeline::Query::kOk) continue;
      result.insert(result.end(), estimate.state.data(),
                    estimate.state.data() + estimate.state.size());
      result.push_back(static_cast<double>(estimate.counts.samples));
    }
    return result;
  }

  ObserverConfig config_;
  std::shared_ptr<const ObserverLaw> law_;
};

TEST_P(GatedTypeTest, EveryOrderOfArrivalGivesTheSameBits) {
  std::map<Effect, int> effects;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    std::mt19937_64 generator(seed);
    std::vector<OwnedEvent> events =
        test::random_events_for(*law_, generator, 60, kStart, 2 * kSecond);
    std::sort(events.begin(), events.end(), [](const OwnedEvent& a, const OwnedEvent& b) {
      return compare(a.view(), b.view()) < 0;
    });
    Estimator reference = make();
    for (const OwnedEvent& event : events) ++effects[take(reference, event).effect];
    const std::vector<double> expected = history(reference);
    for (int permutation = 0; permutation < 5; ++permutation) {
      std::shuffle(events.begin(), events.end(), generator);
      Estimator estimator = make();
      for (const OwnedEvent& event : events) take(estimator, event);
      const std::vector<double> found = history(estimator);
      ASSERT_EQ(expected.size(), found.size());
      EXPECT_EQ(0, std::memcmp(expected.data(), found.data(), found.size() * sizeof(double)));
    }
  }
  EXPECT_GT(effects[Effect::kGated], 10);
  EXPECT_GT(effects[Effect::kPastGate], 0);
}

TEST_P(GatedTypeTest, NothingIsAllocated) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  std::mt19937_64 generator(3);
  const std::vector<OwnedEvent> events =
      test::random_events_for(*law_, generator, 300, kStart, 5 * kSecond);
  Estimator estimator = make();
  const std::size_t before = test::allocations();
  for (const OwnedEvent& event : events) take(estimator, event);
  EXPECT_EQ(before, test::allocations());
}

INSTANTIATE_TEST_SUITE_P(Types, GatedTypeTest, ::testing::ValuesIn(test::type_examples()),
                         [](const auto& info) { return info.param; });

/// A mass on a spring whose position is measured every 0.1 to 0.2 s.
std::string run_config(const std::string& observer_and_gains, const std::string& gate) {
  return observer_and_gains + R"(
plant: {states: [p, v], A: [[0, 1], [-4, -0.1]]}
sensors: {s: {C: [[1, 0]], source: {topic: s})" +
         gate + R"(}}
sampling: {T1: 0.1, T2: 0.2}
initial_estimate: {p: 0.5, v: 0}
)";
}

const char kConstantGain[] = "observer: ConstantGainObserver\ngains: {L: [[0.4], [0.6]]}";
const char kFilter[] =
    "observer: HybridKalmanFilter\n"
    "gains: {P0: [[1, 0], [0, 1]], R: [[0.0025]], Q: [[0, 0], [0, 0.05]], Q_d: [[0, 0], [0, 0]]}";
const char kAbsolute[] = ", gate: {innovation: 0.4, recovery: {after: 1, action: accept}}";
const char kDistance[] = ", gate: {mahalanobis: 4, recovery: {after: 1, action: accept}}";

struct RunResult {
  double rmse = 0.0;      ///< of the position after 2 s
  int outliers = 0;       ///< sent
  int outliers_used = 0;  ///< after the first second
  int good_gated = 0;
  double recovered = 0.0;  ///< first time of a recovery [s]
};

/// @param spoil  changes the measured position at a time; true for an outlier
template <class Spoil>
RunResult simulate(const std::string& text, Spoil spoil) {
  const ObserverConfig config = test::parse(text);
  Estimator estimator(config.law, config.options);
  Estimate estimate = estimator.make_estimate();
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> interval(0.1, 0.2);
  std::normal_distribution<double> noise(0.0, 0.05);
  const double damping = 0.05;
  const double frequency = std::sqrt(4.0 - damping * damping);
  const auto position = [&](double t) { return std::exp(-damping * t) * std::cos(frequency * t); };
  RunResult result;
  double sum = 0.0;
  int count = 0;
  for (double t = 0.0; t < 30.0; t += interval(generator)) {  // NOLINT(cert-flp30-c)
    const Stamp stamp = kStart + from_seconds(t);
    double y = position(t) + noise(generator);
    const bool is_outlier = spoil(t, y, generator);
    const EventReport report = estimator.submit({stamp, EventKind::kSample, 0, &y, 1, 0}, stamp);
    if (report.recovers() && result.recovered == 0.0) result.recovered = t;
    result.outliers += is_outlier ? 1 : 0;
    result.outliers_used += is_outlier && report.used() && t > 1.0 ? 1 : 0;
    result.good_gated += !is_outlier && report.outcome == EventOutcome::kGated ? 1 : 0;
    EXPECT_EQ(Timeline::Query::kOk, estimator.estimate_at(stamp, estimate));
    if (t > 2.0) {
      sum += std::pow(estimate.state(0) - position(t), 2);
      ++count;
    }
  }
  result.rmse = std::sqrt(sum / count);
  return result;
}

bool one_in_ten_is_an_outlier(double t, double& y, std::mt19937_64& generator) {
  static_cast<void>(t);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  if (share(generator) > 0.1) return false;
  y += share(generator) < 0.5 ? 3.0 : -3.0;
  return true;
}

TEST(GatedRunTest, OutliersAreKeptOutAndTheEstimateIsBetterForIt) {
  for (const auto& [gains, gate] :
       {std::make_pair(kConstantGain, kAbsolute), std::make_pair(kFilter, kDistance)}) {
    const RunResult plain = simulate(run_config(gains, ""), one_in_ten_is_an_outlier);
    const RunResult gated = simulate(run_config(gains, gate), one_in_ten_is_an_outlier);
    EXPECT_GT(plain.outliers, 10);
    EXPECT_EQ(0, gated.outliers_used) << gains;
    EXPECT_LE(gated.good_gated, 1) << gains;
    EXPECT_LT(gated.rmse, 0.2 * plain.rmse) << gains;
    EXPECT_LT(gated.rmse, 0.05) << gains;
  }
}

TEST(GatedRunTest, ASensorThatStepsForGoodIsTakenInAgainInTheTimeStated) {
  const auto step = [](double t, double& y, std::mt19937_64&) {
    if (t > 10.0) y += 2.0;
    return false;
  };
  for (const auto& [gains, gate] :
       {std::make_pair(kConstantGain, kAbsolute), std::make_pair(kFilter, kDistance)}) {
    const RunResult gated = simulate(run_config(gains, gate), step);
    // The first rejection comes within T2 of the step, the next sample within T2 of `after`.
    EXPECT_GT(gated.recovered, 11.0) << gains;
    EXPECT_LT(gated.recovered, 11.0 + 2 * 0.2) << gains;
  }
}

}  // namespace
}  // namespace sampled_data_observers
