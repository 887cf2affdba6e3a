// The two numerical examples of ferrante2016, section 5.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "sampled_data_observers/config/observer_config.h"
#include "sampled_data_observers/observer/constant_gain_observer.h"
#include "sampled_data_observers/observer/estimator.h"
#include "sampled_data_observers/plant/linear_plant.h"

namespace sampled_data_observers {
namespace {

constexpr Stamp kStart = kNanosecondsPerSecond;

double uniform(std::mt19937_64& generator, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

/// Example 1: A = M = 1, T1 = T2 = 1, L = 1.1 - 1/e, P = 1.
class ScalarExample {
 public:
  ScalarExample() {
    LinearPlantDescription plant;
    plant.state_names = {"z"};
    plant.A = Eigen::MatrixXd::Ones(1, 1);
    plant.B = Eigen::MatrixXd::Zero(1, 0);
    plant.sensors = {{"y", Eigen::MatrixXd::Ones(1, 1), {false}}};
    plant_ = make_linear_plant(plant);
  }

  Estimator estimator(double initial_estimate) const {
    Estimator::Options options;
    options.history = {20 * kNanosecondsPerSecond, 1000};
    options.sampling = {kNanosecondsPerSecond, kNanosecondsPerSecond};
    return Estimator(std::make_shared<const ConstantGainObserver>(
                         ObserverContext{plant_, Eigen::VectorXd::Constant(1, initial_estimate),
                                         Eigen::VectorXd::Zero(0)},
                         std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Constant(1, 1, kL)}),
                     options);
  }

  static const double kL;
  static double beta() { return std::abs(std::pow(1.0 - kL, 2) * std::exp(2.0) - 1.0); }
  static double theta() { return std::log(1.0 - beta() / std::exp(2.0)); }
  /// gamma = R = |theta| T2 / (1 + T2), both from (20a) with T2 = 1.
  static double gamma() { return -theta() / 2.0; }

  std::shared_ptr<const Plant> plant_;
};

const double ScalarExample::kL = 1.1 - std::exp(-1.0);

TEST(Ferrante2016Example1, TheConstantsAreThePapers) {
  EXPECT_NEAR(0.7321, ScalarExample::kL, 5e-5);
  EXPECT_NEAR(0.4698, ScalarExample::beta(), 5e-5);
  EXPECT_NEAR(-0.0657, ScalarExample::theta(), 5e-5);
  EXPECT_NEAR(0.0328, ScalarExample::gamma(), 5e-5);
}

TEST(Ferrante2016Example1, TheErrorObeysTheExponentialBoundAtEveryInstant) {
  // (21) with alpha_1 = 1, alpha_2 = e^2: |e(t,j)| <= e^{R/2} e e^{-gamma (t+j)/2} |e(0,0)|.
  const ScalarExample example;
  for (const double first_sample : {0.001, 0.3, 1.0}) {
    Estimator estimator = example.estimator(0.0);
    estimator.restart(kStart);  // t = 0, before any sample
    const double z0 = 0.8;
    const auto truth = [&](double t) { return z0 * std::exp(t); };
    const double initial_error = z0;
    int j = 0;
    Estimate estimate = estimator.make_estimate();
    const auto check = [&](double t) {
      ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + from_seconds(t), estimate));
      const double error = std::abs(truth(t) - estimate.state(0));
      const double bound = std::exp(ScalarExample::gamma() / 2.0) * std::exp(1.0) *
                           std::exp(-ScalarExample::gamma() * (t + j) / 2.0) * initial_error;
      EXPECT_LE(error, bound) << "t=" << t << " j=" << j;
    };
    double t = 0.0;
    for (int k = 0; k < 12; ++k) {
      const double sample_time = first_sample + k;
      for (; t < sample_time; t += 0.01) check(t);
      check(sample_time);
      const double y = truth(sample_time);
      const Stamp stamp = kStart + from_seconds(sample_time);
      ASSERT_TRUE(estimator.submit({stamp, EventKind::kSample, 0, &y, 1}, stamp).used());
      ++j;
      check(sample_time);
    }
  }
}

/// Example 2 as shipped: mass and spring with a biased sensor, the printed gain.
class MassSpringExample : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(MassSpringExample, TheErrorFallsBelowAMillionthOfItsStart) {
  const std::string folder =
      std::string(SDO_SOURCE_DIR) + "/config/examples/ferrante2016_mass_spring/";
  ObserverConfig config = read_observer_config(
      std::vector<std::string>{folder + "scenario.yaml", folder + "observer.yaml"},
      no_plant_plugins);
  const Plant& plant = *config.plant;
  const AffineMap& f = *plant.modes()[0].flow->affine();
  const LinearFlow flow(f.M(), f.N());
  ASSERT_EQ(5, plant.states());
  config.options.history = {4 * kNanosecondsPerSecond, 1000};
  Estimator estimator(config.law, config.options);

  std::mt19937_64 generator(GetParam());
  Eigen::VectorXd x(5);
  x << 1.0, -0.5, 0.3, 0.2, 1.0;  // b = 1
  Eigen::VectorXd scratch(5);
  // u = sin t, held between input stamps 10 ms apart for plant and observer alike.
  constexpr Duration kHold = kNanosecondsPerSecond / 100;
  double u = 0.0;
  Stamp now = kStart;
  Stamp next_sample = kStart + from_seconds(uniform(generator, 0.0, 3.0));
  Stamp next_input = kStart;
  Estimate estimate = estimator.make_estimate();
  const double initial_error = x.norm();
  double error = initial_error;
  while (now < kStart + 200 * kNanosecondsPerSecond) {
    if (now == next_input) {
      u = std::sin(to_seconds(now - kStart));
      ASSERT_TRUE(estimator.submit({now, EventKind::kInput, 0, &u, 1}, now).used());
      next_input += kHold;
    }
    if (now == next_sample) {
      const Eigen::VectorXd y = plant.modes()[0].outputs[0]->affine()->M() * x;
      const EventReport report = estimator.submit({now, EventKind::kSample, 0, y.data(), 1}, now);
      ASSERT_TRUE(report.used());
      ASSERT_NE(IntervalCheck::kShort, report.interval_check);
      ASSERT_NE(IntervalCheck::kLong, report.interval_check);
      next_sample += from_seconds(uniform(generator, 0.2, 3.0));
    }
    ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(now, estimate));
    error = (x - estimate.state.head(5)).norm();
    const Stamp next = std::min(next_input, next_sample);
    flow.apply(next - now, x.data(), &u, scratch.data());
    now = next;
  }
  EXPECT_LT(error, 1e-6 * initial_error);
  EXPECT_NEAR(1.0, estimate.state(4), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MassSpringExample, ::testing::Range<std::uint64_t>(0, 10));

}  // namespace
}  // namespace sampled_data_observers
