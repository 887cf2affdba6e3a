#include "plant/covariance_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/allocation_counter.h"
#include "support/matrix_functions.h"

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd flowed(const CovarianceFlow& flow, Duration duration, Eigen::MatrixXd P) {
  Eigen::VectorXd scratch(CovarianceFlow::scratch_size(P.rows()));
  flow.apply(duration, P.data(), scratch.data());
  return P;
}

double relative(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  return (found - expected).norm() / expected.norm();
}

/// By Van Loan's block exponential, in long double; good while |A| t is moderate.
Eigen::MatrixXd van_loan(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q, double t,
                         const Eigen::MatrixXd& P) {
  using test::extended::Matrix;
  const Eigen::Index n = A.rows();
  Matrix block = Matrix::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = -A.cast<long double>();
  block.topRightCorner(n, n) = Q.cast<long double>();
  block.bottomRightCorner(n, n) = A.transpose().cast<long double>();
  const Matrix exponential = test::extended::exponential(block * static_cast<long double>(t));
  const Matrix Phi = exponential.bottomRightCorner(n, n).transpose();
  const Matrix result =
      Phi * P.cast<long double>() * Phi.transpose() + Phi * exponential.topRightCorner(n, n);
  return result.cast<double>();
}

Eigen::MatrixXd matrix2(double a, double b, double c, double d) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << a, b, c, d;
  return matrix;
}

struct Case {
  Eigen::MatrixXd A;
  Eigen::MatrixXd Q;
  Eigen::MatrixXd P;
};

Case stable() {
  return {matrix2(0.0, 1.0, -2.0, -0.7), matrix2(0.1, 0.05, 0.05, 0.4),
          matrix2(1.0, 0.2, 0.2, 2.0)};
}

Case unstable() {
  return {matrix2(0.3, 1.0, -0.5, 0.6), matrix2(0.0, 0.0, 0.0, 1.0), matrix2(1.0, -0.4, -0.4, 3.0)};
}

TEST(CovarianceFlowTest, IsVanLoansForModerateDurations) {
  for (const Case& c : {stable(), unstable()}) {
    const CovarianceFlow flow(c.A, c.Q);
    for (const double t : {1e-6, 0.001, 0.123456789, 1.0, 3.0}) {
      const Eigen::MatrixXd found = flowed(flow, from_seconds(t), c.P);
      EXPECT_LT(relative(found, van_loan(c.A, c.Q, t, c.P)), 1e-14) << t;
      EXPECT_EQ(found, found.transpose());
    }
  }
}

TEST(CovarianceFlowTest, FollowsTheDifferentialEquation) {
  // Runge-Kutta steps so small that their error is below the tolerance.
  const Case c = stable();
  const auto derivative = [&](const Eigen::MatrixXd& P) -> Eigen::MatrixXd {
    return c.A * P + P * c.A.transpose() + c.Q;
  };
  Eigen::MatrixXd P = c.P;
  constexpr int kSteps = 2000;
  constexpr double kStep = 2.5 / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::MatrixXd k1 = derivative(P);
    const Eigen::MatrixXd k2 = derivative(P + kStep / 2.0 * k1);
    const Eigen::MatrixXd k3 = derivative(P + kStep / 2.0 * k2);
    const Eigen::MatrixXd k4 = derivative(P + kStep * k3);
    P += kStep / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  EXPECT_LT(relative(flowed(CovarianceFlow(c.A, c.Q), from_seconds(2.5), c.P), P), 1e-11);
}

TEST(CovarianceFlowTest, ANilpotentPlantHasPolynomials) {
  // x1' = x2, x2' = white noise of intensity q; from one nanosecond to a day.
  constexpr double q = 0.7;
  const CovarianceFlow flow(matrix2(0.0, 1.0, 0.0, 0.0), matrix2(0.0, 0.0, 0.0, q));
  for (const Duration duration :
       {Duration{1}, Duration{999}, from_seconds(1.5), from_seconds(1e5)}) {
    const double t = to_seconds(duration);
    const Eigen::MatrixXd found = flowed(flow, duration, matrix2(0.0, 0.0, 0.0, 0.0));
    EXPECT_NEAR(1.0, found(0, 0) / (q * t * t * t / 3.0), 1e-14) << t;
    EXPECT_NEAR(1.0, found(0, 1) / (q * t * t / 2.0), 1e-14) << t;
    EXPECT_NEAR(1.0, found(1, 1) / (q * t), 1e-14) << t;
    const Eigen::MatrixXd moved = flowed(flow, duration, matrix2(2.0, 0.5, 0.5, 3.0));
    EXPECT_NEAR(1.0, moved(0, 0) / (2.0 + t + 3.0 * t * t + q * t * t * t / 3.0), 1e-14) << t;
  }
}

TEST(CovarianceFlowTest, AStablePlantSettlesAtTheSolutionOfLyapunovsEquation) {
  for (const Case& c : {stable(), Case{matrix2(-1.0, 0.0, 1e6, -1e6), matrix2(1.0, 0.0, 0.0, 5.0),
                                       matrix2(1.0, 0.0, 0.0, 1.0)}}) {
    const Eigen::MatrixXd P = flowed(CovarianceFlow(c.A, c.Q), from_seconds(1e5), c.P);
    const Eigen::MatrixXd drift = c.A * P;
    EXPECT_LT((drift + drift.transpose() + c.Q).norm(), 1e-14 * c.A.norm() * P.norm());
  }
}

TEST(CovarianceFlowTest, AStiffPlantIsExactInEachOfItsModes) {
  // Two uncoupled modes of rates 1e7 and 0.1: P_ii = p e^{2at} + q (e^{2at} - 1) / (2a).
  const Eigen::MatrixXd A = Eigen::Vector2d(-1e7, -0.1).asDiagonal();
  const Eigen::MatrixXd Q = Eigen::Vector2d(3.0, 0.2).asDiagonal();
  const CovarianceFlow flow(A, Q);
  for (const Duration duration :
       {Duration{1}, Duration{100}, from_seconds(1e-3), from_seconds(7.7)}) {
    const Eigen::MatrixXd P = flowed(flow, duration, Eigen::MatrixXd::Identity(2, 2));
    for (Eigen::Index i = 0; i < 2; ++i) {
      const double a = A(i, i);
      const double t = to_seconds(duration);
      const double expected = std::exp(2.0 * a * t) + Q(i, i) * std::expm1(2.0 * a * t) / (2.0 * a);
      EXPECT_NEAR(1.0, P(i, i) / expected, 1e-13) << i << " " << t;
    }
    EXPECT_EQ(0.0, P(0, 1));
  }
}

TEST(CovarianceFlowTest, OneNanosecondAddsItsShareOfTheNoise) {
  const Case c = stable();
  const Eigen::MatrixXd found = flowed(CovarianceFlow(c.A, c.Q), 1, Eigen::MatrixXd::Zero(2, 2));
  const Eigen::MatrixXd first = c.A * c.Q;
  const Eigen::MatrixXd expected = 1e-9 * c.Q + 0.5e-18 * (first + first.transpose());
  EXPECT_LT(relative(found, expected), 1e-15);
}

TEST(CovarianceFlowTest, FlowsCompose) {
  for (const Case& c : {stable(), unstable()}) {
    const CovarianceFlow flow(c.A, c.Q);
    const std::vector<std::pair<Duration, Duration>> pairs = {
        {1, 63}, {123456789, 987654321}, {from_seconds(3.0), 1}, {4095, 4097}};
    for (const auto& [a, b] : pairs) {
      const Eigen::MatrixXd in_two = flowed(flow, b, flowed(flow, a, c.P));
      EXPECT_LT(relative(in_two, flowed(flow, a + b, c.P)), 1e-14) << a << " " << b;
    }
  }
}

TEST(CovarianceFlowTest, AnOverflowIsNotFiniteAndNoTimeIsNoChange) {
  const Case c = unstable();
  const CovarianceFlow flow(c.A, c.Q);
  EXPECT_EQ(c.P, flowed(flow, 0, c.P));
  EXPECT_FALSE(flowed(flow, from_seconds(1e5), c.P).allFinite());
}

TEST(CovarianceFlowTest, AllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const Case c = stable();
  const CovarianceFlow flow(c.A, c.Q);
  Eigen::MatrixXd P = c.P;
  Eigen::VectorXd scratch(CovarianceFlow::scratch_size(2));
  const std::size_t before = test::allocations();
  flow.apply(123456789, P.data(), scratch.data());
  EXPECT_EQ(before, test::allocations());
}

TEST(CovarianceFlowTest, RefusesWhatDoesNotFit) {
  const Eigen::MatrixXd two = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::MatrixXd three = Eigen::MatrixXd::Identity(3, 3);
  EXPECT_NO_THROW(CovarianceFlow(two, two));
  EXPECT_THROW(CovarianceFlow(two, three), std::invalid_argument);
  EXPECT_THROW(CovarianceFlow(Eigen::MatrixXd(2, 3), two), std::invalid_argument);
  EXPECT_THROW(CovarianceFlow(Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0)), std::invalid_argument);
  EXPECT_THROW(CovarianceFlow(two, two * std::numeric_limits<double>::infinity()),
               std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
