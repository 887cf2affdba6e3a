// The hybrid Kalman filter of plants that are not affine: linearized along the estimate.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "observer/hybrid_kalman_filter.h"
#include "sampled_data_observers/hybrid/timeline.h"
#include "support/kalman_plants.h"
#include "support/law_runner.h"
#include "support/matrix_functions.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::after_events;
using test::Disguise;
using test::filter_of_linear_plant;
using test::formulas;
using test::LawRunner;

TEST(ExtendedKalmanFilterTest, OfALinearPlantIsTheLinearFilterToTheAccuracyOfTheIntegration) {
  for (const double deviation : {0.0, 0.02}) {
    const Eigen::VectorXd expected =
        after_events(filter_of_linear_plant<HybridKalmanFilter>({Disguise::kNone, 1, deviation}));
    const auto error = [&](Disguise disguise, Duration step) {
      return (after_events(
                  filter_of_linear_plant<HybridKalmanFilter>({disguise, step, deviation})) -
              expected)
          .norm();
    };
    EXPECT_LT(error(Disguise::kOutputs, 1000000), 1e-12 * expected.norm());
    const double coarse = error(Disguise::kAll, 10000000);
    const double fine = error(Disguise::kAll, 5000000);
    EXPECT_LT(coarse, 1e-4 * expected.norm());
    EXPECT_GT(coarse / fine, 3.5);
    EXPECT_LT(error(Disguise::kAllWithoutDerivatives, 5000000), fine + 1e-8 * expected.norm());
  }
}

/// A point on a plane that does not move, whose distance from the origin is measured.
std::shared_ptr<const HybridKalmanFilter> range_filter(
    int iterations, const Eigen::Vector2d& start = Eigen::Vector2d(1.0, 0.5)) {
  const ExpressionNames names{{"x", "y"}, {}, {}};
  PlantDescription description;
  description.state_names = names.x;
  description.sensors = {{"range", SensorTiming::kSampled, {false}}};
  PlantMode mode;
  mode.flow = std::make_shared<const AffineMap>(Eigen::Matrix2d::Zero());
  mode.outputs = {formulas(names, {"sqrt(x^2 + y^2)"})};
  description.modes = {mode};
  KalmanCovariances covariances;
  covariances.P0 = Eigen::Vector2d(1.0, 0.25).asDiagonal();
  covariances.R = {Eigen::MatrixXd::Constant(1, 1, 1e-2)};
  covariances.Q = Eigen::Matrix2d::Zero();
  covariances.Q_d = Eigen::Matrix2d::Zero();
  covariances.iterations = iterations;
  return std::make_shared<const HybridKalmanFilter>(
      ObserverContext{std::make_shared<const Plant>(description), start, Eigen::VectorXd::Zero(0)},
      covariances);
}

TEST(ExtendedKalmanFilterTest, AnUpdateLinearizesTheOutputAtTheEstimate) {
  const auto law = range_filter(1);
  LawRunner runner(law);
  const Eigen::Vector2d x(1.0, 0.5);
  const Eigen::RowVector2d H = x.transpose() / x.norm();
  const Eigen::Matrix2d P0 = Eigen::Vector2d(1.0, 0.25).asDiagonal();
  const double y = 3.0;
  const Event sample{1, EventKind::kSample, 0, &y, 1};
  Eigen::VectorXd workspace(law->workspace_size());
  const double S = H * P0 * H.transpose() + 1e-2;
  EXPECT_NEAR((y - x.norm()) / std::sqrt(S),
              law->mahalanobis_distance(sample, runner.state().data(), workspace.data()), 1e-13);
  runner.sample(0, {y});
  const Eigen::Vector2d K = P0 * H.transpose() / S;
  EXPECT_LT((x + K * (y - x.norm()) - runner.estimate()).norm(), 1e-13);
  const Eigen::Matrix2d P =
      Eigen::Map<const Eigen::Matrix2d>(law->covariance(runner.state().data()));
  EXPECT_LT((P0 - K * H * P0 - P).norm(), 1e-13);
}

TEST(ExtendedKalmanFilterTest, IterationsFindTheMostProbableState) {
  // Half the gradient of (x - x0)ᵀ P0⁻¹ (x - x0) + (y - |x|)²/R.
  const auto gradient = [](const Eigen::Vector2d& x, double y) -> double {
    const Eigen::Vector2d x0(1.0, 0.5);
    const Eigen::Vector2d prior = Eigen::Vector2d(1.0, 4.0).cwiseProduct(x - x0);
    return (prior - x / x.norm() * (y - x.norm()) / 1e-2).norm();
  };
  std::vector<double> slopes;
  for (const int iterations : {1, 20}) {
    const auto law = range_filter(iterations);
    LawRunner runner(law);
    runner.sample(0, {2.0});
    slopes.push_back(gradient(runner.estimate(), 2.0));
  }
  EXPECT_GT(slopes[0], 0.1);
  EXPECT_LT(slopes[1], 1e-8);
}

/// A vehicle with speed and yaw rate as inputs, both noisy, whose position is measured.
std::shared_ptr<const HybridKalmanFilter> unicycle_filter(double q_v, double q_w, double r) {
  const ExpressionNames names{{"x", "y", "yaw"}, {"v", "w"}, {}};
  PlantDescription description;
  description.state_names = names.x;
  description.input_names = names.u;
  description.sensors = {{"gps", SensorTiming::kSampled, {false, false}}};
  description.integration.step = 20000000;
  PlantMode mode;
  mode.flow = formulas(names, {"v*cos(yaw)", "v*sin(yaw)", "w"});
  mode.outputs = {formulas(names, {"x + 0.3*cos(yaw)", "y + 0.3*sin(yaw)"})};
  description.modes = {mode};
  KalmanCovariances covariances;
  covariances.P0 = Eigen::Vector3d(0.25, 0.25, 0.04).asDiagonal();
  covariances.R = {Eigen::Matrix2d::Identity() * r};
  covariances.Q = Eigen::Vector3d(q_v, q_v, q_w).asDiagonal();
  covariances.Q_d = Eigen::Matrix3d::Zero();
  return std::make_shared<const HybridKalmanFilter>(
      ObserverContext{std::make_shared<const Plant>(description), Eigen::Vector3d::Zero(),
                      Eigen::Vector2d::Zero()},
      covariances);
}

TEST(ExtendedKalmanFilterTest, TheNormalizedErrorsOfAUnicycleAreAsLargeAsTheyShouldBe) {
  const double q_v = 0.01;
  const double q_w = 0.002;
  const double r = 0.04;
  const auto law = unicycle_filter(q_v, q_w, r);
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> steps(5, 40);
  double sum = 0.0;
  int count = 0;
  for (int run = 0; run < 100; ++run) {
    LawRunner runner(law);
    Eigen::Vector3d x(0.5 * normal(generator), 0.5 * normal(generator), 0.2 * normal(generator));
    for (int event = 0; event < 20; ++event) {
      const double v = 1.0;
      const double w = 0.5 * std::sin(0.7 * event);
      runner.input({v, w});
      const int flown = steps(generator);
      const double h = 0.02;
      for (int i = 0; i < flown; ++i) {
        const double yaw = x(2) + 0.5 * h * w;
        x += h * Eigen::Vector3d(v * std::cos(yaw), v * std::sin(yaw), w);
        x(0) += std::sqrt(q_v * h) * normal(generator);
        x(1) += std::sqrt(q_v * h) * normal(generator);
        x(2) += std::sqrt(q_w * h) * normal(generator);
      }
      runner.flow(from_seconds(h) * flown);
      runner.sample(0, {x(0) + 0.3 * std::cos(x(2)) + std::sqrt(r) * normal(generator),
                        x(1) + 0.3 * std::sin(x(2)) + std::sqrt(r) * normal(generator)});
      const Eigen::Vector3d e = x - runner.estimate();
      const Eigen::Matrix3d P =
          Eigen::Map<const Eigen::Matrix3d>(law->covariance(runner.state().data()));
      sum += e.dot(test::inverse(P) * e);
      ++count;
    }
  }
  EXPECT_NEAR(3.0, sum / count, 0.3);
}

/// A direction on the plane as a unit vector, turned by an input; its angle is measured.
std::shared_ptr<const HybridKalmanFilter> direction_filter(const KalmanCovariances& covariances) {
  const ExpressionNames names{{"c", "s"}, {"w"}, {}};
  PlantDescription description;
  description.state_names = names.x;
  description.input_names = names.u;
  description.sensors = {{"compass", SensorTiming::kSampled, {true}}};
  description.integration.step = 10000000;
  description.unit_norms = {{0, 1}};
  PlantMode mode;
  mode.flow = formulas(names, {"-s*w", "c*w"});
  mode.jump = formulas(names, {"-2*s", "2*c"});
  mode.outputs = {formulas(names, {"atan2(s, c)"})};
  description.modes = {mode};
  return std::make_shared<const HybridKalmanFilter>(
      ObserverContext{std::make_shared<const Plant>(description), Eigen::Vector2d(3.0, 4.0),
                      Eigen::VectorXd::Constant(1, 0.8)},
      covariances);
}

TEST(ExtendedKalmanFilterTest, StatesOfUnitNormStayThereAndHaveTheVarianceOfTheAngle) {
  KalmanCovariances covariances;
  covariances.P0 = Eigen::Vector2d(0.3, 0.3).asDiagonal();
  covariances.R = {Eigen::MatrixXd::Constant(1, 1, 0.02)};
  covariances.Q = Eigen::Vector2d(0.05, 0.05).asDiagonal();
  covariances.Q_d = Eigen::Vector2d(0.01, 0.01).asDiagonal();
  const auto law = direction_filter(covariances);
  LawRunner runner(law);
  double variance = 0.3;
  double angle = std::atan2(4.0, 3.0);
  const auto compare = [&](double tolerance) {
    const Eigen::Vector2d q = runner.estimate();
    const Eigen::Vector2d tangent(-q(1), q(0));
    const Eigen::Matrix2d P =
        Eigen::Map<const Eigen::Matrix2d>(law->covariance(runner.state().data()));
    EXPECT_NEAR(1.0, q.norm(), 1e-15);
    EXPECT_NEAR(0.0, (P * q).norm(), 1e-15);
    EXPECT_NEAR(variance, tangent.dot(P * tangent), tolerance);
  };
  compare(1e-15);
  for (int i = 0; i < 10; ++i) {
    runner.flow(test::kSecond / 3);
    angle += 0.8 / 3.0;
    variance += 0.05 / 3.0;
    compare(1e-8);
    if (i % 3 == 2) {
      runner.jump();
      angle += std::acos(0.0);
      // The jump map doubles the vector, but not the angle: neither is its variance.
      variance += 0.01 / 4.0;
      compare(1e-8);
    } else {
      runner.sample(
          0, {std::atan2(runner.estimate()(1), runner.estimate()(0)) + 8.0 * std::acos(0.0)});
      variance -= variance * variance / (variance + 0.02);
      compare(1e-8);
    }
  }
  EXPECT_NEAR(0.0,
              std::remainder(angle - std::atan2(runner.estimate()(1), runner.estimate()(0)),
                             4.0 * std::acos(0.0)),
              1e-8);
}

TEST(ExtendedKalmanFilterTest, AGroupOfZerosBecomesTheFirstUnitVector) {
  KalmanCovariances covariances;
  covariances.P0 = Eigen::Matrix2d::Identity();
  covariances.R = {Eigen::MatrixXd::Constant(1, 1, 0.02)};
  covariances.Q = covariances.Q_d = Eigen::Matrix2d::Zero();
  LawRunner runner(direction_filter(covariances));
  runner.start_from(Eigen::Vector2d::Zero());
  EXPECT_EQ(Eigen::Vector2d(1.0, 0.0), runner.estimate());
}

TEST(ExtendedKalmanFilterTest, WhereTheJacobianHasNoValueASampleHasNoEffect) {
  // At the origin the range has no derivative.
  Timeline timeline(range_filter(1, Eigen::Vector2d::Zero()), {100 * test::kSecond, 100});
  const double y = 1.0;
  EXPECT_EQ(Effect::kNotFinite,
            timeline.insert({test::kStart, EventKind::kSample, 0, &y, 1}).effect);
}

}  // namespace
}  // namespace sampled_data_observers
