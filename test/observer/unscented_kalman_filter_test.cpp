// The Kalman filter with sigma points: the linear one where all is linear, near the extended one
// where little is not, and better where much is.
#include "observer/unscented_kalman_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "observer/hybrid_kalman_filter.h"
#include "observer/sigma_points.h"
#include "support/kalman_plants.h"
#include "support/matrix_functions.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::after_events;
using test::Disguise;
using test::filter_of_linear_plant;
using test::formulas;
using test::LawRunner;

constexpr double kPi = 3.14159265358979323846;

Eigen::MatrixXd covariance_of(const PlantObserver& law, const LawRunner& runner) {
  const Eigen::Index n = law.plant().states();
  return Eigen::Map<const Eigen::MatrixXd>(law.covariance(runner.state().data()), n, n);
}

TEST(UnscentedKalmanFilterTest, OfALinearPlantIsTheLinearFilterToRounding) {
  for (const double deviation : {0.0, 0.02}) {
    const Eigen::VectorXd expected =
        after_events(filter_of_linear_plant<HybridKalmanFilter>({Disguise::kNone, 1, deviation}));
    for (const Disguise disguise : {Disguise::kNone, Disguise::kOutputs}) {
      const Eigen::VectorXd found =
          after_events(filter_of_linear_plant<UnscentedKalmanFilter>({disguise, 1, deviation}));
      EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
    }
  }
}

TEST(UnscentedKalmanFilterTest, OfALinearFlowThatIsIntegratedIsTheExtendedFilterToRounding) {
  for (const double deviation : {0.0, 0.02}) {
    const Eigen::VectorXd expected = after_events(
        filter_of_linear_plant<HybridKalmanFilter>({Disguise::kAll, 10000000, deviation}));
    const Eigen::VectorXd found = after_events(
        filter_of_linear_plant<UnscentedKalmanFilter>({Disguise::kAll, 10000000, deviation}));
    EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
  }
}

struct SmallPlant {
  std::vector<std::string> states;
  std::vector<std::string> flow;
  std::vector<std::string> outputs;
  std::vector<bool> angular;
  Eigen::VectorXd start;
  Eigen::VectorXd P0;  ///< diagonal
  double R = 0.01;
  double Q = 0.0;
  std::vector<std::vector<Eigen::Index>> unit_norms = {};
  std::vector<std::string> jump = {};  ///< no jumps
};

template <class Law>
std::shared_ptr<const Law> filter_of(const SmallPlant& small) {
  const ExpressionNames names{small.states, {}, {}};
  const Eigen::Index n = small.start.size();
  PlantDescription description;
  description.state_names = names.x;
  description.sensors = {{"s", SensorTiming::kSampled, small.angular}};
  description.integration.step = 10000000;
  description.unit_norms = small.unit_norms;
  PlantMode mode;
  mode.flow = formulas(names, small.flow);
  mode.outputs = {formulas(names, small.outputs)};
  if (!small.jump.empty()) mode.jump = formulas(names, small.jump);
  description.modes = {mode};
  const auto m = static_cast<Eigen::Index>(small.angular.size());
  KalmanCovariances covariances;
  covariances.P0 = small.P0.asDiagonal();
  covariances.R = {small.R * Eigen::MatrixXd::Identity(m, m)};
  covariances.Q = small.Q * Eigen::MatrixXd::Identity(n, n);
  covariances.Q_d = Eigen::MatrixXd::Zero(n, n);
  return std::make_shared<const Law>(ObserverContext{std::make_shared<const Plant>(description),
                                                     small.start, Eigen::VectorXd::Zero(0)},
                                     covariances);
}

TEST(UnscentedKalmanFilterTest, OfALittleCurvedPlantIsNearTheExtendedFilter) {
  const SmallPlant pendulum{
      {"angle", "rate"},         {"rate", "-4*sin(angle) - 0.3*rate"}, {"sin(angle)"}, {false},
      Eigen::Vector2d(0.6, 0.0), Eigen::Vector2d(1e-3, 1e-3),          1e-3,           1e-3};
  const auto unscented = filter_of<UnscentedKalmanFilter>(pendulum);
  const auto extended = filter_of<HybridKalmanFilter>(pendulum);
  LawRunner a(unscented);
  LawRunner b(extended);
  for (int i = 0; i < 50; ++i) {
    a.flow(test::kSecond / 10);
    b.flow(test::kSecond / 10);
    const double y = 0.5 * std::cos(2.0 * 0.1 * (i + 1));
    a.sample(0, {y});
    b.sample(0, {y});
    const Eigen::MatrixXd P = covariance_of(*extended, b);
    const Eigen::VectorXd difference = a.estimate() - b.estimate();
    // In standard deviations.
    EXPECT_LT(std::sqrt(difference.dot(test::inverse(P) * difference)), 0.03);
    EXPECT_LT((covariance_of(*unscented, a) - P).norm(), 0.02 * P.norm());
  }
}

TEST(UnscentedKalmanFilterTest, OfAFlowThatCurvesItFollowsTheMean) {
  // x grows by an uncertain rate: its mean is exp(σ² t²/2), where that of the extended filter is 1.
  const double sigma = 0.3;
  const SmallPlant growth{{"x", "rate"}, {"rate*x", "0*x"},         {"x"},
                          {false},       Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(1e-12, 0.09)};
  const auto unscented = filter_of<UnscentedKalmanFilter>(growth);
  const auto extended = filter_of<HybridKalmanFilter>(growth);
  LawRunner a(unscented);
  LawRunner b(extended);
  a.flow(test::kSecond);
  b.flow(test::kSecond);
  const double mean = std::exp(0.5 * sigma * sigma);
  const double variance = std::exp(2.0 * sigma * sigma) - std::exp(sigma * sigma);
  EXPECT_NEAR(1.0, b.estimate()(0), 1e-6);
  EXPECT_NEAR(mean, a.estimate()(0), 0.05 * (mean - 1.0));
  EXPECT_NEAR(variance, covariance_of(*unscented, a)(0, 0),
              0.8 * std::abs(variance - covariance_of(*extended, b)(0, 0)));
}

TEST(UnscentedKalmanFilterTest, AJumpThatSquaresHasTheMeanAndTheVarianceOfTheSquare) {
  const double mu = 0.7;
  const double variance = 0.2;
  SmallPlant square{{"x"},
                    {"0*x"},
                    {"x"},
                    {false},
                    Eigen::VectorXd::Constant(1, mu),
                    Eigen::VectorXd::Constant(1, variance)};
  square.jump = {"x^2"};
  const auto law = filter_of<UnscentedKalmanFilter>(square);
  LawRunner runner(law);
  runner.jump();
  EXPECT_NEAR(mu * mu + variance, runner.estimate()(0), 1e-14);
  EXPECT_NEAR(4.0 * mu * mu * variance + 2.0 * variance * variance,
              covariance_of(*law, runner)(0, 0), 1e-14);
}

/// Errors of one update by a distance, over many true positions.
struct UpdateErrors {
  double square = 0.0;      ///< mean of e_x²
  double normalized = 0.0;  ///< mean of eᵀ P⁻¹ e
};

template <class Law>
UpdateErrors errors_of_range_updates() {
  // What is known across the line of sight is so vague that the circle curves away from it.
  const SmallPlant range{{"x", "y"},
                         {"0*y", "0*x"},
                         {"sqrt(x^2 + y^2)"},
                         {false},
                         Eigen::Vector2d(1.0, 0.0),
                         Eigen::Vector2d(0.01, 0.16),
                         1e-4};
  const auto law = filter_of<Law>(range);
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  UpdateErrors errors;
  const int runs = 2000;
  for (int run = 0; run < runs; ++run) {
    LawRunner runner(law);
    const Eigen::Vector2d x(1.0 + 0.1 * normal(generator), 0.4 * normal(generator));
    runner.sample(0, {x.norm() + 0.01 * normal(generator)});
    const Eigen::Vector2d e = x - runner.estimate();
    errors.square += e(0) * e(0) / runs;
    errors.normalized += e.dot(test::inverse(covariance_of(*law, runner)) * e) / runs;
  }
  return errors;
}

TEST(UnscentedKalmanFilterTest, OfAnOutputThatCurvesItIsBetterAndKnowsHowGoodItIs) {
  const UpdateErrors unscented = errors_of_range_updates<UnscentedKalmanFilter>();
  const UpdateErrors extended = errors_of_range_updates<HybridKalmanFilter>();
  EXPECT_NEAR(2.0, unscented.normalized, 0.5);
  EXPECT_GT(extended.normalized, 50.0);
  EXPECT_LT(unscented.square, 0.7 * extended.square);
  std::cout << "normalized errors: " << unscented.normalized << ", extended " << extended.normalized
            << "; mean square along the line of sight: " << unscented.square / extended.square
            << " of that of the extended filter\n";
}

TEST(UnscentedKalmanFilterTest, AnglesMayCrossPi) {
  const auto angle = [](const std::string& output, double start) {
    return filter_of<UnscentedKalmanFilter>({{"yaw", "rate"},
                                             {"rate", "0*yaw"},
                                             {output},
                                             {true},
                                             Eigen::Vector2d(start, 0.1),
                                             Eigen::Vector2d(0.04, 0.01)});
  };
  const auto wrapped = angle("atan2(sin(yaw), cos(yaw))", kPi - 0.05);
  const auto plain = angle("yaw", kPi - 0.05);
  LawRunner a(wrapped);
  LawRunner b(plain);
  for (const double y : {-kPi + 0.02, kPi - 0.03, -kPi + 0.1}) {
    a.flow(test::kSecond / 5);
    b.flow(test::kSecond / 5);
    const Event sample{1, EventKind::kSample, 0, &y, 1};
    Eigen::VectorXd workspace(wrapped->workspace_size() + plain->workspace_size());
    EXPECT_NEAR(plain->mahalanobis_distance(sample, b.state().data(), workspace.data()),
                wrapped->mahalanobis_distance(sample, a.state().data(), workspace.data()), 1e-12);
    a.sample(0, {y});
    b.sample(0, {y});
    EXPECT_LT((a.estimate() - b.estimate()).norm(), 1e-12);
    EXPECT_LT((covariance_of(*wrapped, a) - covariance_of(*plain, b)).norm(), 1e-13);
  }
}

TEST(UnscentedKalmanFilterTest, StatesOfUnitNormStayThereAndPIsPositiveSemidefinite) {
  SmallPlant direction{{"c", "s", "w"},
                       {"-s*w", "c*w", "0*c"},
                       {"atan2(s, c)"},
                       {true},
                       Eigen::Vector3d(1.0, 0.0, 0.5),
                       Eigen::Vector3d(0.2, 0.2, 0.04),
                       0.02,
                       0.05};
  direction.unit_norms = {{0, 1}};
  const auto law = filter_of<UnscentedKalmanFilter>(direction);
  LawRunner runner(law);
  double angle = 0.0;
  for (int i = 0; i < 60; ++i) {
    runner.flow(test::kSecond / 4);
    angle += 0.6 / 4.0;
    runner.sample(0, {std::remainder(angle, 2.0 * kPi)});
    const Eigen::Vector3d x = runner.estimate();
    const Eigen::MatrixXd P = covariance_of(*law, runner);
    EXPECT_NEAR(1.0, x.head(2).norm(), 1e-15);
    EXPECT_LT((P.leftCols(2) * x.head(2)).norm(), 1e-15);
    const double in_turns = std::remainder(angle - std::atan2(x(1), x(0)), 2.0 * kPi);
    if (i > 20) {
      EXPECT_LT(std::abs(in_turns), 0.02);
    }
    const Eigen::Vector3d tangent(-x(1), x(0), 0.0);
    Eigen::Matrix2d left;
    left << tangent.dot(P * tangent), tangent.dot(P.col(2)), tangent.dot(P.col(2)), P(2, 2);
    EXPECT_TRUE(factor_cholesky(left.data(), 2));
  }
}

TEST(SigmaPointsTest, MeanAndVarianceOfASumOfSquaresAreExactForAnyNumberOfVariables) {
  // The weights of the points are 1 - n/3 and 1/6: with them the variance would be 3 n - n².
  for (const Eigen::Index n : {1, 2, 5, 12}) {
    const Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    const Eigen::MatrixXd factor = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd point(n);
    Eigen::VectorXd spread(2 * n);
    spread_of_points(x.data(), factor.data(), n, 1, point.data(), spread.data(),
                     [n](double* at, double* out) { *out = dot(at, at, n); });
    double mean = 0.0;
    double variance = 0.0;
    add_shift_of_mean(spread.data(), n, 1, &mean);
    add_covariance_of_spread(spread.data(), n, 1, &variance);
    const auto count = static_cast<double>(n);
    EXPECT_NEAR(count, mean, 1e-13 * count);
    EXPECT_NEAR(2.0 * count, variance, 1e-13 * count);
  }
}

TEST(SigmaPointsTest, ASemidefiniteMatrixHasAFactorWithoutItsNullSpace) {
  Eigen::Matrix3d M;
  M << 4.0, 2.0, -2.0, 2.0, 1.0, -1.0, -2.0, -1.0, 10.0;
  Eigen::Matrix3d L = M;
  factor_semidefinite(L.data(), 3);
  EXPECT_LT((L * L.transpose() - M).norm(), 1e-14);
  EXPECT_EQ(0.0, L.col(1).norm());
  L.setZero();
  factor_semidefinite(L.data(), 3);
  EXPECT_EQ(0.0, L.norm());
  L(0, 0) = std::nan("");
  factor_semidefinite(L.data(), 3);
  EXPECT_TRUE(std::isnan(L(0, 0)));
}

}  // namespace
}  // namespace sampled_data_observers
