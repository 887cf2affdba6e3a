// Gates: which samples are kept out, how a gate recovers, and what the Kalman filter's measure.
#include "observer/gated_measurements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "observer/hybrid_kalman_filter.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/matrix_functions.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::kStart;

constexpr int kPosition = 0;  // sensors of test::example_law()
constexpr int kPose = 1;

Gate absolute(std::vector<double> limits, Duration after = 2 * kSecond,
              Gate::Recovery recovery = Gate::Recovery::kAccept) {
  Gate gate;
  gate.innovation =
      Eigen::Map<const Eigen::VectorXd>(limits.data(), static_cast<Eigen::Index>(limits.size()));
  gate.recover_after = after;
  gate.recovery = recovery;
  return gate;
}

/// A law driven by hand.
class Runner {
 public:
  explicit Runner(std::shared_ptr<const ObserverLaw> law)
      : law_(std::move(law)), state_(law_->state_size()), workspace_(law_->workspace_size()) {
    law_->initialize(state_.data());
  }

  void flow(Duration duration) { law_->flow(duration, state_.data(), workspace_.data()); }
  Effect take(EventKind kind, int channel, const std::vector<double>& values) {
    return law_->reset(event(kind, channel, values), state_.data(), workspace_.data());
  }
  Effect sample(int sensor, const std::vector<double>& y) {
    return take(EventKind::kSample, sensor, y);
  }
  /// A sample with a given innovation.
  Effect sample_off(int sensor, std::vector<double> innovation) {
    Eigen::VectorXd zero(static_cast<Eigen::Index>(innovation.size()));
    const std::vector<double> nothing(innovation.size(), 0.0);
    law_->observer().innovation(event(EventKind::kSample, sensor, nothing), state_.data(),
                                zero.data());
    for (std::size_t i = 0; i < innovation.size(); ++i) {
      innovation[i] -= zero(static_cast<Eigen::Index>(i));
    }
    return sample(sensor, innovation);
  }
  double distance(int sensor, const std::vector<double>& y) {
    return law_->observer().mahalanobis_distance(event(EventKind::kSample, sensor, y),
                                                 state_.data(), workspace_.data());
  }
  Eigen::VectorXd estimate() const { return state_.head(law_->estimate_size()); }
  Eigen::VectorXd& state() { return state_; }

 private:
  static Event event(EventKind kind, int channel, const std::vector<double>& values) {
    return {1, kind, channel, values.data(), static_cast<Eigen::Index>(values.size()), 0};
  }

  std::shared_ptr<const ObserverLaw> law_;
  Eigen::VectorXd state_;
  Eigen::VectorXd workspace_;
};

std::shared_ptr<const ObserverLaw> gated(std::optional<Gate> position,
                                         std::optional<Gate> pose = std::nullopt) {
  return std::make_shared<const GatedMeasurements>(
      test::example_law(), std::vector<std::optional<Gate>>{std::move(position), std::move(pose)});
}

TEST(GatedMeasurementsTest, ASampleOutsideHasNoEffectAndOneInsideHasTheUsualOne) {
  Runner runner(gated(absolute({0.5})));
  Runner plain(test::example_law());
  for (Runner* each : {&runner, &plain}) {
    EXPECT_EQ(Effect::kApplied, each->sample_off(kPosition, {0.1}));
    each->flow(kSecond / 3);
  }
  const Eigen::VectorXd before = runner.estimate();
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {0.51}));
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {-0.51}));
  EXPECT_EQ(before, runner.estimate());
  for (Runner* each : {&runner, &plain}) {
    EXPECT_EQ(Effect::kApplied, each->sample_off(kPosition, {0.49}));
  }
  EXPECT_EQ(plain.estimate(), runner.estimate());
}

TEST(GatedMeasurementsTest, EachOutputHasItsLimitAndAnglesAreWrapped) {
  Runner runner(gated(std::nullopt, absolute({1.0, 0.2})));
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPose, {0.0, 0.0}));
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPose, {0.9, 0.21}));
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPose, {1.1, 0.19}));
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPose, {0.9, 0.19 - 2.0 * std::acos(-1.0)}));
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPosition, {50.0}));  // no gate
}

TEST(GatedMeasurementsTest, AGateIsOpenUntilASampleLiesInsideIt) {
  Runner runner(gated(absolute({0.5})));
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPosition, {30.0}));
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPosition, {-30.0}));
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPosition, {0.4}));
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {30.0}));
}

TEST(GatedMeasurementsTest, AfterRejectionsOnlySamplesAreUsedAgain) {
  Runner runner(gated(absolute({0.5}, 2 * kSecond)));
  runner.sample_off(kPosition, {0.0});
  runner.flow(10 * kSecond);  // no rejection yet: this time does not count
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {3.0}));
  runner.flow(2 * kSecond - 1);
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {3.0}));
  runner.flow(1);
  EXPECT_EQ(Effect::kPastGate, runner.sample_off(kPosition, {3.0}));
  EXPECT_EQ(Effect::kPastGate, runner.sample_off(kPosition, {1.2}));
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPosition, {0.4}));
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {3.0}));
}

TEST(GatedMeasurementsTest, ASampleInsideEndsTheTimeOfRejections) {
  Runner runner(gated(absolute({0.5}, 2 * kSecond)));
  runner.sample_off(kPosition, {0.0});
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {3.0}));
  runner.flow(kSecond);
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPosition, {0.1}));
  runner.flow(kSecond + kSecond / 2);
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {3.0}));
}

TEST(GatedMeasurementsTest, ItMayBeginAnewInstead) {
  const auto law = gated(absolute({0.5}, kSecond, Gate::Recovery::kReset), absolute({0.1, 0.1}));
  Runner runner(law);
  runner.sample_off(kPosition, {0.0});
  runner.sample_off(kPose, {0.0, 0.0});
  runner.take(EventKind::kInput, 0, {0.7, -0.2});
  runner.flow(kSecond);
  EXPECT_EQ(Effect::kGated, runner.sample_off(kPosition, {9.0}));
  runner.flow(kSecond);
  EXPECT_EQ(Effect::kRestarted, runner.sample(kPosition, {4.0}));

  Runner expected(test::example_law());
  expected.take(EventKind::kInput, 0, {0.7, -0.2});
  expected.sample(kPosition, {4.0});
  EXPECT_EQ(expected.estimate(), runner.estimate());
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPose, {5.0, 1.0}));  // all gates are open
  EXPECT_EQ(Effect::kApplied, runner.sample_off(kPosition, {4.0}));
  runner.flow(kSecond / 4);
  expected.sample_off(kPose, {5.0, 1.0});
  expected.sample_off(kPosition, {4.0});
  expected.flow(kSecond / 4);  // under the input that goes on holding
  EXPECT_EQ(expected.estimate(), runner.estimate());
}

TEST(GatedMeasurementsTest, ItsSamplesAreReportedAndNotCounted) {
  Estimator::Options options;
  options.history = {100 * kSecond, 3};
  options.sampling = {kSecond / 10, kSecond};
  Estimator estimator(gated(absolute({0.5}, 5 * kSecond)), options);
  Estimate estimate = estimator.make_estimate();
  const auto submit = [&](Stamp stamp, double off) {
    const double y =
        off +
        (estimator.estimate_at(stamp, estimate) == Timeline::Query::kOk ? estimate.state(0) : 0.3);
    return estimator.submit({stamp, EventKind::kSample, kPosition, &y, 1, 0}, stamp);
  };
  submit(kStart, 0.0);
  EXPECT_EQ(EventOutcome::kUsed, submit(kStart + kSecond / 2, 0.1).outcome);
  for (int i = 1; i <= 5; ++i) {
    const EventReport report = submit(kStart + kSecond / 2 + i * kSecond, 2.0);
    EXPECT_EQ(EventOutcome::kGated, report.outcome);
    EXPECT_FALSE(report.used());
    EXPECT_FALSE(report.interval);
  }
  ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + 6 * kSecond, estimate));
  EXPECT_EQ(2u, estimate.counts.samples);
  EXPECT_EQ(7u, estimate.counts.events);
  EXPECT_EQ(kStart + kSecond / 2, estimate.counts.last_sample);
  const EventReport report = submit(kStart + 13 * kSecond / 2, 2.0);
  EXPECT_EQ(EventOutcome::kUsed, report.outcome);
  EXPECT_TRUE(report.recovers());
  // Since the last one used, though that one has left the history.
  EXPECT_EQ(6 * kSecond, report.interval);
  EXPECT_EQ(IntervalCheck::kLong, report.interval_check);
}

TEST(GatedMeasurementsTest, RefusesGatesThatMakeNoSense) {
  const auto fault = [](const Gate& gate) -> std::string {
    try {
      gated(gate);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ("", fault(absolute({0.5})));
  EXPECT_NE("", fault(absolute({0.5, 0.5})));
  EXPECT_NE("", fault(absolute({0.0})));
  EXPECT_NE("", fault(absolute({0.5}, 0)));
  Gate mahalanobis;
  mahalanobis.mahalanobis = 3.0;
  mahalanobis.recover_after = kSecond;
  EXPECT_NE(std::string::npos, fault(mahalanobis).find("covariance"));
  EXPECT_THROW(GatedMeasurements(test::example_law(), {absolute({0.5})}), std::invalid_argument);
}

/// A filter of two states with one sensor of two outputs.
class KalmanGateTest : public ::testing::Test {
 protected:
  KalmanGateTest() {
    PlantDescription plant;
    plant.state_names = {"p", "v"};
    plant.sensors = {{"s", SensorTiming::kSampled, {false, false}}};
    PlantMode mode;
    mode.flow = std::make_shared<const AffineMap>(A_);
    mode.outputs = {std::make_shared<const AffineMap>(C_)};
    plant.modes = {mode};
    law_ = std::make_shared<const HybridKalmanFilter>(
        ObserverContext{std::make_shared<const Plant>(plant), Eigen::Vector2d::Zero(),
                        Eigen::VectorXd::Zero(0)},
        KalmanCovariances{P0_, {R_}, Q_, Eigen::Matrix2d::Zero()});
  }

  static Eigen::Matrix2d matrix(double a, double b, double c, double d) {
    Eigen::Matrix2d M;
    M << a, b, c, d;
    return M;
  }

  const Eigen::Matrix2d A_ = matrix(0.0, 1.0, 0.0, 0.0);
  const Eigen::Matrix2d C_ = matrix(1.0, 0.0, 1.0, 0.5);
  const Eigen::Matrix2d P0_ = matrix(1.0, 0.2, 0.2, 2.0);
  const Eigen::Matrix2d R_ = matrix(0.1, 0.04, 0.04, 0.2);
  const Eigen::Matrix2d Q_ = matrix(0.0, 0.0, 0.0, 0.3);
  std::shared_ptr<const HybridKalmanFilter> law_;
};

TEST_F(KalmanGateTest, TheDistanceIsTheTextbooks) {
  Runner runner(law_);
  for (int i = 0; i < 20; ++i) {
    runner.flow(kSecond / 3);
    const Eigen::Map<const Eigen::Matrix2d> P(law_->observer().covariance(runner.state().data()));
    const Eigen::Vector2d y(std::sin(i), 2.0 * std::cos(3 * i));
    const Eigen::Vector2d nu = y - C_ * runner.estimate();
    const Eigen::Matrix2d S = C_ * P * C_.transpose() + R_;
    const double expected = std::sqrt(nu.dot(test::inverse(S) * nu));
    EXPECT_NEAR(expected, runner.distance(0, {y(0), y(1)}), 1e-12 * expected);
    runner.sample(0, {y(0), y(1)});
  }
}

TEST_F(KalmanGateTest, OfAPlantThatIsAsAssumedItKeepsOutWhatChiSquareSays) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  const Eigen::Matrix2d noise_root =
      matrix(std::sqrt(0.1), 0.0, 0.04 / std::sqrt(0.1), std::sqrt(0.2 - 0.016));
  const double dt = 0.2;
  // The square root of the process noise over dt: (0.3 dt) [dt²/3 dt/2; dt/2 1].
  const Eigen::Matrix2d drift_root =
      std::sqrt(0.3 * dt) * matrix(dt / std::sqrt(3.0), 0.0, std::sqrt(0.75), 0.5);
  Runner runner(law_);
  const Eigen::Matrix2d start_root = matrix(1.0, 0.0, 0.2, std::sqrt(1.96));
  const auto noise = [&]() -> Eigen::Vector2d { return {normal(generator), normal(generator)}; };
  Eigen::Vector2d x = start_root * noise();
  const int samples = 20000;
  const std::vector<double> limits = {1.0, 2.0, 3.0};
  std::vector<int> outside(limits.size(), 0);
  for (int i = 0; i < samples; ++i) {
    x = matrix(1.0, dt, 0.0, 1.0) * x + drift_root * noise();
    const Eigen::Vector2d y = C_ * x + noise_root * noise();
    runner.flow(from_seconds(dt));
    const double distance = runner.distance(0, {y(0), y(1)});
    for (std::size_t k = 0; k < limits.size(); ++k) outside[k] += distance > limits[k] ? 1 : 0;
    runner.sample(0, {y(0), y(1)});
  }
  for (std::size_t k = 0; k < limits.size(); ++k) {
    // Two outputs: the square is beyond γ² with probability exp(−γ²/2).
    const double share = std::exp(-limits[k] * limits[k] / 2.0);
    const double deviation = std::sqrt(samples * share * (1.0 - share));
    EXPECT_NEAR(samples * share, outside[k], 4.0 * deviation) << limits[k];
  }
}

TEST_F(KalmanGateTest, TheGateWidensWithTheCovariance) {
  Gate gate;
  gate.mahalanobis = 3.0;
  gate.recover_after = 1000 * kSecond;
  Runner runner(
      std::make_shared<const GatedMeasurements>(law_, std::vector<std::optional<Gate>>{gate}));
  for (int i = 0; i < 20; ++i) {
    runner.flow(kSecond / 10);
    EXPECT_EQ(Effect::kApplied, runner.sample_off(0, {0.0, 0.0}));
  }
  EXPECT_EQ(Effect::kGated, runner.sample_off(0, {5.0, 5.0}));
  runner.flow(20 * kSecond);
  EXPECT_EQ(Effect::kApplied, runner.sample_off(0, {5.0, 5.0}));
}

}  // namespace
}  // namespace sampled_data_observers
