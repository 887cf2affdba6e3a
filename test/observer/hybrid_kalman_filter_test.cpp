#include "observer/hybrid_kalman_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "linear_algebra/matrix_functions.h"
#include "sampled_data_observers/runtime/estimator.h"
#include "support/law_runner.h"
#include "support/matrix_functions.h"
#include "support/random_events.h"
#include "support/stamps.h"

namespace sampled_data_observers {
namespace {

using test::kSecond;
using test::LawRunner;
using test::OwnedEvent;

std::shared_ptr<const VectorMap> linear_map(const Eigen::MatrixXd& M) {
  return std::make_shared<const AffineMap>(M);
}

/// Three states, one sensor of two outputs that is sampled (0) and one of one output at jumps (1).
std::shared_ptr<const Plant> plant(const Eigen::Matrix3d& A, const Eigen::Matrix3d& A_d,
                                   const Eigen::MatrixXd& C, const Eigen::RowVector3d& H_d) {
  PlantDescription description;
  description.state_names = {"x1", "x2", "x3"};
  description.sensors = {{"a", SensorTiming::kSampled, {false, false}},
                         {"d", SensorTiming::kAtJumps, {false}}};
  PlantMode mode;
  mode.flow = linear_map(A);
  mode.jump = linear_map(A_d);
  mode.outputs = {linear_map(C), linear_map(H_d)};
  description.modes = {mode};
  return std::make_shared<const Plant>(description);
}

Eigen::Matrix3d example_A() {
  Eigen::Matrix3d A;
  A << 0.0, 1.0, 0.0, -2.0, -0.3, 0.5, 0.1, 0.0, -0.2;
  return A;
}

Eigen::MatrixXd example_C() {
  Eigen::MatrixXd C(2, 3);
  C << 1.0, 0.0, 0.0, 0.5, 0.0, 1.0;
  return C;
}

Eigen::Matrix3d example_A_d() {
  Eigen::Matrix3d A_d;
  A_d << 1.0, 0.0, 0.0, 0.0, -0.8, 0.1, 0.0, 0.0, 1.0;
  return A_d;
}

KalmanCovariances example_covariances() {
  KalmanCovariances covariances;
  covariances.P0 = Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal();
  Eigen::Matrix2d R;
  R << 0.1, 0.03, 0.03, 0.2;
  covariances.R = {R, Eigen::MatrixXd::Constant(1, 1, 0.05)};
  covariances.Q = Eigen::Vector3d(0.0, 0.3, 0.1).asDiagonal();
  covariances.Q_d = Eigen::Vector3d(0.01, 0.0, 0.02).asDiagonal();
  return covariances;
}

std::shared_ptr<const HybridKalmanFilter> example_filter(double stamp_deviation = 0.0) {
  const auto of = plant(example_A(), example_A_d(), example_C(), Eigen::RowVector3d(0.0, 1.0, 0.0));
  KalmanCovariances covariances = example_covariances();
  covariances.stamp_deviation = stamp_deviation;
  return std::make_shared<const HybridKalmanFilter>(
      ObserverContext{of, Eigen::Vector3d(0.5, -1.0, 0.2), Eigen::VectorXd::Zero(0)}, covariances);
}

Eigen::Matrix3d covariance(const ObserverLaw& law, const LawRunner& runner) {
  return Eigen::Map<const Eigen::Matrix3d>(law.observer().covariance(runner.state().data()));
}

/// The textbook filter, with Eigen.
struct Textbook {
  Eigen::Vector3d x = Eigen::Vector3d(0.5, -1.0, 0.2);
  KalmanCovariances tuning = example_covariances();
  Eigen::Matrix3d P = tuning.P0;

  /// Van Loan: exp([-A Q; 0 A'] t) = [. Phi^-1 Q_t; 0 Phi'].
  void flow(double t) {
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(6, 6);
    M.topLeftCorner(3, 3) = -example_A() * t;
    M.topRightCorner(3, 3) = tuning.Q * t;
    M.bottomRightCorner(3, 3) = example_A().transpose() * t;
    const Eigen::MatrixXd E = test::exponential(M);
    const Eigen::Matrix3d Phi = E.bottomRightCorner(3, 3).transpose();
    x = Phi * x;
    P = Phi * P * Phi.transpose() + Phi * E.topRightCorner(3, 3);
  }
  void correct(const Eigen::MatrixXd& C, const Eigen::MatrixXd& R, const Eigen::VectorXd& y) {
    const Eigen::MatrixXd K = P * C.transpose() * test::inverse(C * P * C.transpose() + R);
    x += K * (y - C * x);
    P = (Eigen::Matrix3d::Identity() - K * C) * P;
  }
  void jump() {
    x = example_A_d() * x;
    P = example_A_d() * P * example_A_d().transpose() + tuning.Q_d;
  }
};

TEST(HybridKalmanFilterTest, IsTheTextbooksFilter) {
  const auto law = example_filter();
  LawRunner runner(law);
  Textbook expected;
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> value(-2.0, 2.0);
  std::uniform_real_distribution<double> interval(0.001, 0.8);
  for (int i = 0; i < 200; ++i) {
    const double t = interval(generator);
    runner.flow(from_seconds(t));
    expected.flow(to_seconds(from_seconds(t)));
    const Eigen::Vector2d y(value(generator), value(generator));
    if (i % 3 == 0) {
      const bool measured = i % 2 == 0;
      if (measured) {
        expected.correct(Eigen::RowVector3d(0.0, 1.0, 0.0), expected.tuning.R[1], y.head(1));
        runner.jump({y(0)});
      } else {
        runner.jump();
      }
      expected.jump();
    } else {
      runner.sample(0, {y(0), y(1)});
      expected.correct(example_C(), expected.tuning.R[0], y);
    }
    ASSERT_LT((expected.x - runner.estimate()).norm(), 1e-10 * (1.0 + expected.x.norm())) << i;
    ASSERT_LT((expected.P - covariance(*law, runner)).norm(), 1e-10 * expected.P.norm()) << i;
  }
  EXPECT_GT(expected.P.norm(), 0.01);
}

class StampDeviationTest : public ::testing::TestWithParam<double> {};

TEST_P(StampDeviationTest, TheCovarianceStaysSymmetricAndPositiveDefinite) {
  const auto law = example_filter(GetParam());
  LawRunner runner(law);
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> value(-2.0, 2.0);
  std::uniform_real_distribution<double> exponent(0.0, 11.0);  // 1 ns to 100 s
  for (int i = 0; i < 100000; ++i) {
    runner.flow(static_cast<Duration>(std::pow(10.0, exponent(generator))));
    switch (generator() % 4) {
      case 0:
        runner.jump();
        break;
      case 1:
        runner.jump({value(generator)});
        break;
      default:
        runner.sample(0, {value(generator), value(generator)});
    }
    const Eigen::Matrix3d P = covariance(*law, runner);
    ASSERT_EQ(P, P.transpose()) << i;
    ASSERT_TRUE(cholesky_root(P).allFinite()) << i << "\n" << P;
  }
}

INSTANTIATE_TEST_SUITE_P(CertainAndUncertain, StampDeviationTest, ::testing::Values(0.0, 0.05));

TEST(HybridKalmanFilterTest, FindsTheStateOfSystem16InItsStandardForm) {
  // Example 5.5 of bernard2022 with tau = 2, 5: the printed (40), with the gain of the jump before,
  // leaves 4.6e-3 after 60 jumps.
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  A(0, 1) = 1.0;
  Eigen::Matrix3d A_d = Eigen::Matrix3d::Zero();
  A_d(0, 0) = A_d(1, 1) = A_d(2, 0) = 1.0;
  KalmanCovariances covariances;
  covariances.P0 = Eigen::Matrix3d::Identity();
  covariances.R = {Eigen::Matrix2d::Identity(), Eigen::MatrixXd::Identity(1, 1)};
  covariances.Q = Eigen::Matrix3d::Zero();
  covariances.Q_d = Eigen::Matrix3d::Identity();
  const auto law = std::make_shared<const HybridKalmanFilter>(
      ObserverContext{plant(A, A_d, example_C(), Eigen::RowVector3d(1.0, 0.0, 0.0)),
                      Eigen::Vector3d::Zero(), Eigen::VectorXd::Zero(0)},
      covariances);
  LawRunner runner(law);
  Eigen::Vector3d x(1.0, -0.5, 3.0);
  for (int k = 0; k < 60; ++k) {
    const double tau = k % 2 == 0 ? 2.0 : 5.0;
    x(0) += tau * x(1);
    runner.flow(from_seconds(tau));
    runner.jump({x(0)});
    x(2) = x(0);
  }
  EXPECT_LT((x - runner.estimate()).norm(), 1e-12 * x.norm());
}

TEST(HybridKalmanFilterTest, AnOutputOfEqualStampJoinsTheJumpInAnyOrderOfArrival) {
  Estimator::Options options;
  options.history = {10 * kSecond, 100};
  options.sampling = {kSecond, kSecond};
  constexpr Stamp kStart = 1000 * kSecond;
  const Stamp at = kStart + kSecond / 3;
  std::vector<OwnedEvent> events = {{kStart, EventKind::kSample, 0, {0.3, 0.1}},
                                    {at, EventKind::kJump, 0, {}},
                                    {at, EventKind::kSample, 0, {0.5, 0.2}},
                                    {at, EventKind::kJumpOutput, 1, {0.9}}};
  const auto less = [](const OwnedEvent& a, const OwnedEvent& b) {
    return compare(a.view(), b.view()) < 0;
  };
  std::sort(events.begin(), events.end(), less);
  Eigen::VectorXd first;
  do {
    Estimator estimator(example_filter(), options);
    for (const OwnedEvent& event : events) estimator.submit(event.view(), kStart + kSecond);
    Estimate estimate = estimator.make_estimate();
    ASSERT_EQ(Timeline::Query::kOk, estimator.estimate_at(kStart + kSecond, estimate));
    if (first.size() == 0) first = estimate.state;
    EXPECT_EQ(first, estimate.state);
  } while (std::next_permutation(events.begin(), events.end(), less));

  // A sample of the jump's stamp counts after it, as with the output in the event.
  LawRunner in_event(example_filter());
  LawRunner beside(example_filter());
  in_event.flow(kSecond / 3);
  in_event.jump({0.9});
  in_event.sample(0, {0.5, 0.2});
  beside.flow(kSecond / 3);
  beside.jump();
  beside.jump_output(1, {0.9});
  beside.sample(0, {0.5, 0.2});
  EXPECT_EQ(in_event.estimate(), beside.estimate());
}

TEST(HybridKalmanFilterTest, ARestartBeginsWithTheFirstCovariance) {
  const auto law = example_filter();
  LawRunner runner(law);
  runner.sample(0, {1.0, 2.0});
  Eigen::VectorXd state = runner.state();
  const Eigen::Vector3d x(7.0, 8.0, 9.0);
  law->start_from(x.data(), state.data());
  EXPECT_EQ(x, state.head(3));
  EXPECT_EQ(Eigen::Matrix3d(example_covariances().P0),
            Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix3d>(law->covariance(state.data()))));
}

TEST(HybridKalmanFilterTest, RefusesCovariancesThatAreNone) {
  const auto fault = [](const KalmanCovariances& covariances) -> std::string {
    try {
      const auto of =
          plant(example_A(), example_A_d(), example_C(), Eigen::RowVector3d(0.0, 1.0, 0.0));
      const HybridKalmanFilter filter({of, Eigen::Vector3d::Zero(), Eigen::VectorXd::Zero(0)},
                                      covariances);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ("", fault(example_covariances()));
  KalmanCovariances covariances = example_covariances();
  covariances.P0(0, 0) = -1.0;
  EXPECT_NE(std::string::npos, fault(covariances).find("P0"));
  covariances = example_covariances();
  covariances.P0(0, 1) = 0.1;
  EXPECT_NE(std::string::npos, fault(covariances).find("P0"));
  covariances = example_covariances();
  covariances.R[0].setZero();
  EXPECT_NE(std::string::npos, fault(covariances).find("R of sensor 'a'"));
  covariances = example_covariances();
  covariances.Q(0, 0) = -1e-3;
  EXPECT_NE(std::string::npos, fault(covariances).find("Q"));
  covariances = example_covariances();
  covariances.Q_d.resize(2, 2);
  EXPECT_NE(std::string::npos, fault(covariances).find("Q_d"));
}

}  // namespace
}  // namespace sampled_data_observers
