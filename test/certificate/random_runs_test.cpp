// Guaranteed bounds in 10,000 random runs for each gain file: errors, noise and disturbances within
// what is assumed, some of them as bad as they may be, at random times within [T1, T2].
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "certificate/certified_gains.h"
#include "certificate/disturbed_flow.h"
#include "certificate/state_shares.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/long_tests.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

constexpr int kRuns = 2000;
constexpr int kRunsOfLongTests = 10000;
constexpr int kEventsPerRun = 12;
constexpr int kPartsPerInterval = 3;
constexpr Duration kStep = 10'000'000;

/// Plays plant, sensors and jumps against an estimator.
class RandomRuns {
 public:
  RandomRuns(const ObserverConfig& config, Certificate certificate, ErrorAssumptions assumptions)
      : config_(config),
        plant_(*config.plant),
        certificate_(std::move(certificate)),
        assumptions_(assumptions),
        flow_(plant_, certificate_.subject.plant.N, kStep),
        shares_(*config.law),
        estimate_(Estimator(config.law, config.options).make_estimate()) {}

  void run(std::uint64_t seed) {
    generator_.seed(seed);
    manner_ = static_cast<int>(seed % 4);
    stamp_ = kStart;
    mode_ = 0;
    // The estimate begins with a restart, or with the first event.
    const bool begins_with_event = seed / 4 % 2 == 0;
    estimator_.emplace(config_.law, config_.options);
    if (!begins_with_event) estimator_->restart(stamp_);
    config_.law->initialize(estimate_.state.data());
    const double size = manner_ == 0 ? uniform(0.0, 1.0) : 1.0;
    x_ = estimate_.state.head(plant_.states()) +
         size * assumptions_.initial_error * direction(plant_.states());
    if (begins_with_event) event();
    compare();
    for (int i = 0; i < kEventsPerRun; ++i) {
      // The time to the first sample may be short.
      const bool is_first = i == 0 && !begins_with_event;
      const double T1 = is_first ? 1e-3 : certificate_.subject.T1;
      const double T2 = certificate_.subject.T2;
      double interval = uniform(T1, T2);
      if (uniform(0.0, 1.0) < 0.3) interval = uniform(0.0, 1.0) < 0.5 ? T1 : T2;
      flow(from_seconds(interval));
      event();
      compare();
    }
  }

  std::size_t violations() const { return violations_; }
  std::size_t losses() const { return losses_; }
  /// The largest share of the bound that the error took.
  double largest_share() const { return largest_share_; }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }

  Eigen::VectorXd direction(Eigen::Index size) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd result(size);
    for (Eigen::Index i = 0; i < size; ++i) result(i) = normal(generator_);
    return result.normalized();
  }

  Eigen::VectorXd error() { return x_ - estimate_.state.head(plant_.states()); }

  /// A vector of at most this norm: none, any, or one that drives the error out along `worst`.
  Eigen::VectorXd perturbation(double norm, const Eigen::VectorXd& worst) {
    if (manner_ == 1 || worst.size() == 0) return Eigen::VectorXd::Zero(worst.size());
    if (manner_ == 0) return uniform(0.0, norm) * direction(worst.size());
    const double sign = manner_ == 2 ? 1.0 : -1.0;
    return worst.isZero() ? Eigen::VectorXd(norm * direction(worst.size()))
                          : Eigen::VectorXd(sign * norm * worst.normalized());
  }

  void flow(Duration interval) {
    const Eigen::MatrixXd& N = certificate_.subject.plant.N;
    for (int part = 0; part < kPartsPerInterval; ++part) {
      const Duration duration =
          interval * (part + 1) / kPartsPerInterval - interval * part / kPartsPerInterval;
      const Eigen::VectorXd w = perturbation(assumptions_.disturbance, N.transpose() * error());
      flow_.apply(mode_, w, duration, x_);
      stamp_ += duration;
      compare();
    }
  }

  Eigen::VectorXd measurement(std::size_t sensor) {
    const AffineMap& map = *plant_.modes()[mode_].outputs[sensor]->affine();
    const Eigen::VectorXd worst = -(map.M() * error());
    return map.M() * x_ + map.c() + perturbation(assumptions_.noise, worst);
  }

  /// A sample of the plant's sensor, or a jump where it has none.
  void event() {
    for (std::size_t i = 0; i < plant_.sensors().size(); ++i) {
      if (plant_.sensors()[i].timing != SensorTiming::kSampled) continue;
      const Eigen::VectorXd y = measurement(i);
      submit({stamp_, EventKind::kSample, static_cast<int>(i), y.data(), y.size(), 0});
      return;
    }
    jump();
  }

  void jump() {
    const std::vector<PlantMode>& modes = plant_.modes();
    const std::size_t next =
        static_cast<std::size_t>(uniform(0.0, 1.0) * static_cast<double>(modes.size()));
    std::vector<double> values;
    for (std::size_t i = 0; i < plant_.sensors().size(); ++i) {
      if (plant_.sensors()[i].timing != SensorTiming::kAtJumps) continue;
      const Eigen::VectorXd y = measurement(i);
      values.insert(values.end(), y.data(), y.data() + y.size());
    }
    if (modes[mode_].jump) {
      const AffineMap& map = *modes[mode_].jump->affine();
      x_ = Eigen::VectorXd(map.M() * x_ + map.c());
    }
    mode_ = next;
    Event jump{stamp_, EventKind::kJump, 0, values.data(),
               static_cast<Eigen::Index>(values.size())};
    if (plant_.switches()) jump.mode = modes[next].label;
    submit(jump);
  }

  void submit(const Event& event) { ASSERT_TRUE(estimator_->submit(event, event.stamp).used()); }

  void compare() {
    ASSERT_EQ(Timeline::Query::kOk, estimator_->estimate_at(stamp_, estimate_));
    const double bound = config_.law->error_bound(estimate_.state.data());
    if (!std::isfinite(bound)) ++losses_;
    const double norm = error().norm();
    // The estimate is rounded, in digits of the state.
    const double rounding = 1e-12 * (1.0 + x_.norm());
    if (norm > bound * (1.0 + 1e-9) + rounding) ++violations_;
    if (shares_.largest(estimate_.state, error(), rounding) > 1.0 + 1e-9) ++violations_;
    if (bound > 1e-6) largest_share_ = std::max(largest_share_, norm / bound);
  }

  const ObserverConfig& config_;
  const Plant& plant_;
  Certificate certificate_;
  ErrorAssumptions assumptions_;
  DisturbedFlow flow_;
  StateShares shares_;
  std::optional<Estimator> estimator_;
  Estimate estimate_;
  std::mt19937_64 generator_;
  int manner_ = 0;
  Stamp stamp_ = 0;
  std::size_t mode_ = 0;
  Eigen::VectorXd x_;
  std::size_t violations_ = 0;
  std::size_t losses_ = 0;
  double largest_share_ = 0.0;
};

/// A gain file, and what is assumed.
struct Claim {
  const char* gains;
  ErrorAssumptions assumptions;
};

const Claim kClaims[] = {
    {"config/examples/ferrante2016_scalar/gains.yaml", {1.0, 0.0, 0.0}},
    {"config/examples/ferrante2016_scalar/gains.yaml", {1.0, 0.1, 0.0}},
    {"config/examples/ferrante2016_mass_spring/gains.yaml", {1.0, 0.1, 0.0}},
    {"test/certificate/ferrante2019_oscillator_0.2.yaml", {1.0, 0.0, 0.0}},
    {"test/certificate/ferrante2019_oscillator_0.2.yaml", {1.0, 0.05, 0.5}},
    {"test/certificate/ferrante2019_oscillator_0.2.yaml", {0.0, 0.0, 1.0}},
    {"test/certificate/ferrante2019_oscillator_0.2.yaml", {0.0, 0.1, 0.0}},
    {"test/certificate/ferrante2019_oscillator_0.41.yaml", {1.0, 0.05, 0.5}},
    {"config/examples/sferlazza2019_aircraft_1_3/gains.yaml", {1.0, 0.0, 0.0}},
    {"config/examples/etienne2019_dc_drive/gains.yaml", {1.0, 0.0, 0.0}},
    {"config/examples/etienne2019_dc_drive/gains.yaml", {1.0, 0.1, 0.0}},
    {"config/examples/bernard2022_impulsive/gains.yaml", {1.0, 0.0, 0.0}},
    {"config/examples/bernard2022_bouncing_ball/gains.yaml", {1.0, 0.0, 0.0}},
    {"test/certificate/bernard2022_bouncing_ball_equation26.yaml", {1.0, 0.0, 0.0}},
};

std::string assumptions_text(const ErrorAssumptions& assumptions) {
  return "{initial_error: " + std::to_string(assumptions.initial_error) +
         ", noise: " + std::to_string(assumptions.noise) +
         ", disturbance: " + std::to_string(assumptions.disturbance) + "}";
}

/// Runs against the bound that these gains have, and returns the largest share of it that was seen.
double attack(CertifiedGains& gains, const ErrorAssumptions& assumptions, int count) {
  const Certificate certificate = gains.certificate();
  const ObserverConfig config = gains.assuming(assumptions_text(assumptions)).config();
  RandomRuns runs(config, certificate, assumptions);
  for (int seed = 0; seed < count && !::testing::Test::HasFailure(); ++seed) {
    runs.run(static_cast<std::uint64_t>(seed));
    EXPECT_EQ(0u, runs.violations()) << "seed " << seed;
    EXPECT_EQ(0u, runs.losses()) << "seed " << seed;
  }
  return runs.largest_share();
}

class BoundTest : public ::testing::TestWithParam<Claim> {};

TEST_P(BoundTest, HoldsInRandomRuns) {
  const Claim& claim = GetParam();
  CertifiedGains gains(claim.gains);
  gains.without(kRunTimeCertificate);  // whose bound is another one
  const double share =
      attack(gains, claim.assumptions, long_tests_are_wanted() ? kRunsOfLongTests : kRuns);
  // Otherwise the test would not notice a bound of another size.
  EXPECT_GT(share, 0.05);
  RecordProperty("largest_share", std::to_string(share));
}

INSTANTIATE_TEST_SUITE_P(EveryClaim, BoundTest, ::testing::ValuesIn(kClaims));

/// Gains whose bound at run time follows from a second proof.
const Claim kSecondProofs[] = {
    {"config/examples/ferrante2016_mass_spring/gains.yaml", {0.0, 0.1, 0.0}},
    {"config/examples/ferrante2019_oscillator/gains.yaml", {1.0, 0.05, 0.5}},
    {"config/examples/sferlazza2019_aircraft_1_3/gains.yaml", {0.0, 0.1, 0.0}},
    {"config/examples/sferlazza2019_aircraft_4_8/gains.yaml", {0.0, 0.1, 0.0}},
    {"config/examples/bernard2022_impulsive/gains.yaml", {0.0, 0.1, 0.0}},
    {"config/examples/bernard2022_bouncing_ball/gains.yaml", {0.0, 0.1, 0.0}},
};

class SecondProofTest : public ::testing::TestWithParam<Claim> {};

TEST_P(SecondProofTest, HoldsInRandomRuns) {
  const Claim& claim = GetParam();
  CertifiedGains gains(claim.gains);
  const double share =
      attack(gains, claim.assumptions, long_tests_are_wanted() ? kRunsOfLongTests : kRuns);
  EXPECT_GT(share, 0.05);
  RecordProperty("largest_share", std::to_string(share));
}

INSTANTIATE_TEST_SUITE_P(EveryClaim, SecondProofTest, ::testing::ValuesIn(kSecondProofs));

}  // namespace
}  // namespace sampled_data_observers::test
