// Guaranteed bounds where the stamps of jumps are off: an attack on them by runs in which jumps are
// told up to jumps/stamp_error before or after they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "certificate/certified_gains.h"
#include "certificate/true_run.h"
#include "support/long_tests.h"

namespace sampled_data_observers::test {
namespace {

const char kImpulsiveGains[] = "config/examples/bernard2022_impulsive/gains.yaml";
const char kBall[] = "config/examples/bernard2022_bouncing_ball/gains.yaml";
const char kTwoOutputs[] = "test/certificate/attack/impulsive/bernard2022_corollary5_2.yaml";
const char kEquation26[] = "test/certificate/bernard2022_bouncing_ball_equation26.yaml";
const char kFast[] = "{x1: 0, x2: 50, x3: 0}";
const char kAtRest[] = "{x1: 0, x2: 0, x3: 0}";
const char kFalling[] = "{theta: 5, omega: 0}";

/// What is attacked: gains, with assumptions.
struct Attack {
  const char* gains;
  const char* initial_estimate;
  double stamp_error;
  double initial_error;
  double noise;
  double disturbance;
  double T1;
  double T2;
  /// The least share of a bound that the attack is to come to, so that it would notice one of
  /// another size.
  double share;
};

ObserverConfig config_of(const Attack& attack, bool declares = true) {
  CertifiedGains gains(attack.gains);
  gains.with(std::string("initial_estimate: ") + attack.initial_estimate);
  gains.assuming("{initial_error: " + std::to_string(attack.initial_error) +
                 ", noise: " + std::to_string(attack.noise) +
                 ", disturbance: " + std::to_string(attack.disturbance) + "}");
  if (attack.disturbance > 0.0) {
    gains.with("certificate: {N: [[0], [1], [0]]}").without(kRunTimeCertificate);
  }
  gains.with("history: {duration: 1000, max_events: 1000}");
  if (declares) {
    gains.with("jumps: {stamp_error: " + std::to_string(attack.stamp_error) + "}");
  }
  return gains.config();
}

struct Found {
  int finite = 0;
  int near = 0;
  int lost = 0;
  int exceeded = 0;
  double largest_share = 0.0;
  // Where the bound is finite.
  double largest_error = 0.0;
  double largest_bound = 0.0;

  void add(const TrueRun::Comparison& comparison) {
    if (std::isfinite(comparison.bound.value)) {
      largest_error = std::max(largest_error, comparison.error);
      largest_bound = std::max(largest_bound, comparison.bound.value);
      ++finite;
      if (!comparison.holds()) ++exceeded;
      if (comparison.bound.value > 0.0) {
        largest_share = std::max(largest_share, comparison.error / comparison.bound.value);
      }
    } else if (comparison.bound.loss == BoundLoss::kNearJump) {
      ++near;
    } else {
      ++lost;
    }
  }
};

class Attacker {
 public:
  explicit Attacker(std::uint64_t seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  /// Mostly one of the ends.
  double extreme(double size) {
    return chance(0.7) ? (chance(0.5) ? size : -size) : uniform(-size, size);
  }
  Eigen::VectorXd direction(Eigen::Index n) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd result(n);
    for (Eigen::Index i = 0; i < n; ++i) result(i) = normal(generator_);
    return result.normalized();
  }

  /// One run, with comparisons everywhere and many around its jumps.
  void run(const Attack& attack, const ObserverConfig& config, bool strays, Found& found) {
    constexpr int kJumps = 12;
    const double delta = attack.stamp_error;
    const Eigen::Index n = config.plant->states();
    const Eigen::MatrixXd N = attack.disturbance > 0.0
                                  ? Eigen::MatrixXd(Eigen::VectorXd::Unit(n, 1))
                                  : Eigen::MatrixXd(n, 0);
    TrueRun run(config, attack.initial_error * direction(n), N);
    double time = 3.0 * delta;
    std::vector<double> looks;
    for (int i = 0; i < kJumps; ++i) {
      double interval =
          chance(0.5) ? (chance(0.5) ? attack.T1 : attack.T2) : uniform(attack.T1, attack.T2);
      if (strays && chance(0.3)) interval *= uniform(0.1, 3.0);
      // Told in the order in which they are, and apart.
      interval = std::max(interval, 4.01 * delta);
      const double end = time + interval;
      for (int k = 0; k < 4; ++k) looks.push_back(uniform(time, end));
      if (attack.disturbance > 0.0) {
        for (const double at : {time, end - delta}) {
          run.disturb(at, Eigen::VectorXd::Constant(1, extreme(attack.disturbance)));
        }
      }
      time = end;
      const double error = extreme(delta);
      if (strays && chance(0.1)) {
        run.unmeasured_jump(time, delta, error);
      } else {
        run.jump(time, delta, error, extreme(attack.noise));
      }
      for (const double around : {-2.02, -1.01, -1.0, -0.5, 0.0, 0.5, 1.0, 1.01, 2.02}) {
        looks.push_back(time + around * delta);
        looks.push_back(time + error + around * delta);
      }
    }
    run.tell(time + 10.0);
    for (const double look : looks) found.add(run.compare(look, look + 10.0));
  }

 private:
  std::mt19937_64 generator_;
};

class JumpStampErrorTest : public ::testing::TestWithParam<Attack> {};

TEST_P(JumpStampErrorTest, NoErrorIsAboveItsBoundWhereverJumpsAreWithinTheirStamps) {
  const Attack& attack = GetParam();
  const ObserverConfig config = config_of(attack);
  Found found;
  Found of_strays;
  const std::uint64_t seeds = long_tests_are_wanted() ? 300 : 90;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Attacker attacker(seed);
    const bool strays = seed % 3 == 2;
    attacker.run(attack, config, strays, strays ? of_strays : found);
    ASSERT_EQ(0, found.exceeded + of_strays.exceeded) << seed;
  }
  EXPECT_EQ(0, found.lost + of_strays.lost);
  EXPECT_GT(found.finite, found.near);
  EXPECT_GT(found.largest_share, attack.share);
  RecordProperty("share", std::to_string(found.largest_share));
  RecordProperty("finite", found.finite);
}

TEST_P(JumpStampErrorTest, UndeclaredItBreaksTheBound) {
  const ObserverConfig config = config_of(GetParam(), false);
  Found found;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Attacker(seed).run(GetParam(), config, false, found);
  }
  EXPECT_GT(found.exceeded, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Attacks, JumpStampErrorTest,
    ::testing::Values(Attack{kImpulsiveGains, kFast, 0.05, 0.0, 0.0, 0.0, 2.0, 5.0, 0.2},
                      Attack{kImpulsiveGains, kFast, 0.001, 0.0, 0.0, 0.0, 2.0, 5.0, 0.2},
                      Attack{kImpulsiveGains, kAtRest, 0.01, 1.0, 0.0, 0.0, 2.0, 5.0, 0.2},
                      Attack{kImpulsiveGains, kFast, 0.001, 0.1, 0.01, 0.0, 2.0, 5.0, 0.2},
                      Attack{kImpulsiveGains, kAtRest, 0.2, 0.0, 0.0, 0.5, 2.0, 5.0, 0.1},
                      Attack{kBall, kFalling, 0.005, 0.0, 0.0, 0.0, 0.3, 2.0, 0.02},
                      Attack{kBall, kFalling, 0.001, 0.5, 0.01, 0.0, 0.1, 2.0, 0.02},
                      Attack{kEquation26, kFalling, 0.002, 0.0, 0.001, 0.0, 0.2, 1.0, 0.01},
                      Attack{kTwoOutputs, kFast, 0.02, 0.0, 0.01, 0.0, 0.3, 0.5, 0.01}));

TEST(JumpStampErrorRunTest, TheBoundIsKnownSoMuchLaterAndNotAroundAJump) {
  const ObserverConfig config =
      config_of({kImpulsiveGains, kFast, 0.1, 0.5, 0.0, 0.0, 2.0, 5.0, 0.0});
  TrueRun run(config, Eigen::Vector3d(0.3, 0.0, 0.4));
  run.jump(3.0, 0.0, 0.1);
  run.tell(4.0);
  const auto loss = [&](double seconds, double now) {
    return run.compare(seconds, now).bound.loss;
  };
  // Just after the start a jump told before it may be yet to come.
  EXPECT_EQ(BoundLoss::kNearJump, loss(0.1, 1.0));
  EXPECT_EQ(BoundLoss::kNone, loss(0.101, 1.0));
  EXPECT_EQ(BoundLoss::kStillOnTheirWay, loss(2.0, 2.099));
  EXPECT_EQ(BoundLoss::kNone, loss(2.0, 2.1));
  EXPECT_EQ(BoundLoss::kNone, loss(2.999, 3.2));
  EXPECT_EQ(BoundLoss::kNearJump, loss(3.0, 3.2));
  EXPECT_EQ(BoundLoss::kNearJump, loss(3.2, 4.0));
  EXPECT_EQ(BoundLoss::kNone, loss(3.201, 4.0));
}

TEST(JumpStampErrorRunTest, JumpsToldTooNearToOneAnotherLoseIt) {
  for (const double apart : {0.2, 0.201}) {
    const ObserverConfig config =
        config_of({kImpulsiveGains, kFast, 0.1, 0.5, 0.0, 0.0, 2.0, 5.0, 0.0});
    TrueRun run(config, Eigen::Vector3d(0.3, 0.0, 0.4));
    run.jump(3.0, 0.0);
    run.jump(3.0 + apart, 0.0);
    run.tell(9.0);
    EXPECT_EQ(apart > 0.2 ? BoundLoss::kNone : BoundLoss::kUncertainJump,
              run.compare(5.0, 9.0).bound.loss);
  }
}

// What Theorem 6.4 of bernard2022 says of late jumps, of early ones as well; and of the bound.
TEST(JumpStampErrorRunTest, OutsideOfTheTimesInQuestionErrorAndBoundAreOfTheirOrder) {
  double error_per_second = 0.0;
  double bound_per_second = 0.0;
  for (const double delta : {0.001, 0.00025, 0.0000625}) {
    // The times between stamps, too, lie within [T1, T2].
    const Attack attack{kImpulsiveGains, kFast, delta, 0.0, 0.0, 0.0, 2.1, 4.9, 0.0};
    const ObserverConfig config = config_of(attack);
    Found found;
    for (std::uint64_t seed = 0; seed < 30; ++seed)
      Attacker(seed).run(attack, config, false, found);
    if (error_per_second > 0.0) {
      EXPECT_NEAR(1.0, found.largest_error / delta / error_per_second, 0.01) << delta;
      EXPECT_NEAR(1.0, found.largest_bound / delta / bound_per_second, 0.1) << delta;
    }
    error_per_second = found.largest_error / delta;
    bound_per_second = found.largest_bound / delta;
  }
}

TEST(JumpStampErrorRunTest, InputsLoseIt) {
  const ObserverConfig config = CertifiedGains(kImpulsiveGains)
                                    .with("plant: {inputs: [u], B: [[0], [1], [0]]}")
                                    .with("jumps: {stamp_error: 0.1}")
                                    .with_own_hash()
                                    .assuming("{initial_error: 0.5, noise: 0}")
                                    .config();
  TrueRun run(config, Eigen::Vector3d(0.3, 0.0, 0.4));
  run.jump(3.0, 0.0);
  run.tell(9.0);
  EXPECT_EQ(BoundLoss::kNone, run.compare(2.5, 9.0).bound.loss);
  EXPECT_EQ(BoundLoss::kUncertainJump, run.compare(4.0, 9.0).bound.loss);
}

TEST(JumpStampErrorRunTest, ANewLawGoesOnFromWhatIsKnownAlsoNearAJump) {
  const ObserverConfig config =
      config_of({kImpulsiveGains, kFast, 0.1, 0.5, 0.0, 0.0, 2.0, 5.0, 0.0});
  for (const double reload : {2.85, 3.05, 3.5}) {
    TrueRun run(config, Eigen::Vector3d(0.3, 0.0, 0.4));
    run.jump(3.0, 0.0, 0.1);
    run.tell(reload);
    Estimator next(config.law, config.options);
    next.take_over(run.estimator(), TrueRun::stamp_of(reload));
    run.estimator() = std::move(next);
    run.tell(4.0);
    EXPECT_EQ(BoundLoss::kNone, run.compare(4.0, 5.0).bound.loss) << reload;
    EXPECT_TRUE(run.compare(4.0, 5.0).holds()) << reload;
    // Where the law of before answers, too.
    EXPECT_EQ(BoundLoss::kNearJump, run.compare(3.04, 5.0).bound.loss) << reload;
    EXPECT_EQ(BoundLoss::kNone, run.compare(2.8, 5.0).bound.loss) << reload;
  }
}

TEST(JumpStampErrorRunTest, ItMustFitIntoTheHistoryWhereThereAreBounds) {
  const auto config = [](const std::string& stamp_error) {
    return CertifiedGains(kImpulsiveGains)
        .with("history: {duration: 1, max_events: 10}")
        .with("future_tolerance: 0.1")
        .with("jumps: {stamp_error: " + stamp_error + "}")
        .assuming("{initial_error: 0.5, noise: 0, latency: 0.5}")
        .config();
  };
  EXPECT_NO_THROW(config("0.49"));
  EXPECT_THROW(config("0.5"), ConfigError);
}

}  // namespace
}  // namespace sampled_data_observers::test
