// What a quadratic form that is bounded says of the entries of a vector, and what a linear flow
// makes of it.
#include "certificate/sublevel_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "certificate/flown_errors.h"
#include "certificate/form_maximum.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers::test {
namespace {

double binomial(int n, int k) {
  double result = 1.0;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// Of whole numbers; its inverse has the entries 1/(i + j + 1).
Eigen::MatrixXd inverse_hilbert_matrix(int n) {
  Eigen::MatrixXd P(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double sign = (i + j) % 2 == 0 ? 1.0 : -1.0;
      P(i, j) = sign * (i + j + 1) * binomial(n + i, n - j - 1) * binomial(n + j, n - i - 1) *
                binomial(i + j, i) * binomial(i + j, i);
    }
  }
  return P;
}

TEST(SublevelSetTest, OfTwoStatesIsWhatTheInverseSays) {
  Eigen::MatrixXd P(2, 2);
  P << 4.0, 2.0, 2.0, 3.0;
  Eigen::MatrixXd inverse(2, 2);
  inverse << 3.0, -2.0, -2.0, 4.0;
  inverse /= 8.0;
  const SublevelSet set(P, 1.0);
  Eigen::VectorXd bounds(2);
  Eigen::MatrixXd Q(2, 2);
  set.bounds(2.0, bounds);
  set.ellipsoid(2.0, Q);
  EXPECT_GT(bounds(0), 2.0 * std::sqrt(3.0 / 8.0));
  EXPECT_GT(bounds(1), 2.0 * std::sqrt(4.0 / 8.0));
  EXPECT_NEAR(bounds(0), 2.0 * std::sqrt(3.0 / 8.0), 1e-8);
  EXPECT_NEAR(bounds(1), 2.0 * std::sqrt(4.0 / 8.0), 1e-8);
  EXPECT_GT(min_eigenvalue(Q - 4.0 * inverse), 0.0);
  EXPECT_LT((Q - 4.0 * inverse).norm(), 1e-8);
}

TEST(SublevelSetTest, HoldsWhereRoundingHidesMuchOfTheInverse) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  for (int n = 2; n <= 7; ++n) {  // κ is 1.9e1 to 4.8e8
    const Eigen::MatrixXd X = inverse_above(inverse_hilbert_matrix(n), 0.1);
    for (int i = 0; i < n; ++i) {
      EXPECT_GT(X(i, i), 1.0 / (2 * i + 1)) << n;
      EXPECT_LT(X(i, i), 1.1 / (2 * i + 1)) << n;
    }
    for (int repetition = 0; repetition < 100; ++repetition) {
      std::vector<long double> v;
      for (int i = 0; i < n; ++i) v.push_back(normal(generator));
      // Along the eigenvectors of small eigenvalues, too.
      const Eigen::VectorXd along = inverse_hilbert_matrix(n).col(repetition % n).normalized();
      if (repetition < n) v.assign(along.data(), along.data() + n);
      long double room = 0.0L;
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          room += v[static_cast<std::size_t>(i)] * v[static_cast<std::size_t>(j)] *
                  (static_cast<long double>(X(i, j)) - 1.0L / (i + j + 1));
        }
      }
      EXPECT_GE(room, 0.0L) << n;
    }
  }
}

TEST(SublevelSetTest, DoesNotDependOnUnits) {
  const Eigen::MatrixXd P = inverse_hilbert_matrix(4);
  const Eigen::VectorXd d = Eigen::Vector4d(0x1p-30, 1.0, 0x1p20, 0x1p-7);
  const Eigen::MatrixXd scaled = d.asDiagonal() * P * d.asDiagonal();
  const Eigen::MatrixXd X = inverse_above(scaled, 1e-30);
  const Eigen::MatrixXd back = d.asDiagonal() * X * d.asDiagonal();
  EXPECT_LT((back - inverse_above(P, 0.1)).norm(), 1e-10);
}

TEST(SublevelSetTest, IsABallWhereTheInverseIsLost) {
  Eigen::MatrixXd P(2, 2);
  P << 1.0, 1.0 - 0x1p-53, 1.0 - 0x1p-53, 1.0;
  const Eigen::MatrixXd X = inverse_above(P, 0x1p-54);
  EXPECT_EQ(0.0, X(0, 1));
  EXPECT_GE(X(0, 0), 0x1p54);
  EXPECT_LE(X(1, 1), 0x1.00001p54);
}

TEST(FormMaximumTest, IsThatOfOneVectorAndLittleMoreOverAnEllipsoid) {
  const Eigen::MatrixXd M = inverse_hilbert_matrix(4);
  const FormMaximum maximum(M, M.cwiseAbs());
  const Eigen::Vector4d e(1.0, -2.0, 3.0, 0.5);
  const double of_e = e.dot(M * e);
  EXPECT_GE(maximum.over(e * e.transpose()), of_e);
  EXPECT_NEAR(maximum.over(e * e.transpose()), of_e, 1e-6 * of_e);
  // The largest of e' M e with e' M e <= 9.
  const Eigen::MatrixXd Q = 9.0 * inverse_above(M, 0.1);
  EXPECT_GE(maximum.over(Q), 9.0);
  EXPECT_LE(maximum.over(Q), 1.001 * 9.0 * 2.0);  // √n of it
  const Eigen::MatrixXd ball = Eigen::MatrixXd::Identity(4, 4);
  EXPECT_GE(maximum.over(ball), max_eigenvalue(M));
  EXPECT_LE(maximum.over(ball), (1.0 + 1e-6) * M.norm());
  EXPECT_EQ(0.0, maximum.over(0.0 * ball));
}

/// x' = v, v' = 0, in any coordinates.
class FlownErrorsTest : public ::testing::Test {
 protected:
  FlownErrors errors(const std::vector<Eigen::MatrixXd>& shapes) {
    std::vector<FlownErrors::Shape> exact;
    for (const Eigen::MatrixXd& X : shapes) exact.push_back({X, 0.0 * X});
    FlownErrors result(A_, flow_growth(A_, 1.0), exact);
    workspace_.resize(result.workspace_size());
    return result;
  }

  Eigen::MatrixXd A_ = (Eigen::MatrixXd(2, 2) << 0.0, 1.0, 0.0, 0.0).finished();
  Eigen::VectorXd workspace_;
  Eigen::VectorXd bounds_ = Eigen::VectorXd(2);
  Eigen::MatrixXd Q_ = Eigen::MatrixXd(2, 2);
};

TEST_F(FlownErrorsTest, OfABallAreWhatTheFlowMakesOfIt) {
  const FlownErrors errors = this->errors({Eigen::MatrixXd::Identity(2, 2)});
  for (const double tau : {0.0, 0.3, 2.0}) {
    errors.bounds(tau, {{0, 5.0}}, workspace_.data(), bounds_);
    EXPECT_GE(bounds_(0), 5.0 * std::sqrt(1.0 + tau * tau));
    EXPECT_NEAR(bounds_(0), 5.0 * std::sqrt(1.0 + tau * tau), 1e-6);
    EXPECT_GE(bounds_(1), 5.0);
    EXPECT_NEAR(bounds_(1), 5.0, 1e-6);
    errors.ellipsoid(tau, {{0, 5.0}}, workspace_.data(), Q_);
    Eigen::MatrixXd exact(2, 2);
    exact << 1.0 + tau * tau, tau, tau, 1.0;
    EXPECT_GE(min_eigenvalue(Q_ - 25.0 * exact), 0.0) << tau;
    EXPECT_LT((Q_ - 25.0 * exact).norm(), 1e-5) << tau;
  }
}

TEST_F(FlownErrorsTest, OfTwoBallsAddUp) {
  const Eigen::MatrixXd along = (Eigen::MatrixXd(2, 1) << 0.0, 2.0).finished();
  const FlownErrors errors = this->errors({Eigen::MatrixXd::Identity(2, 2), along});
  errors.bounds(3.0, {{0, 1.0}, {1, 0.5}}, workspace_.data(), bounds_);
  EXPECT_NEAR(bounds_(0), std::sqrt(10.0) + 3.0, 1e-6);
  EXPECT_NEAR(bounds_(1), 2.0, 1e-6);
  errors.ellipsoid(3.0, {{0, 1.0}, {1, 0.5}}, workspace_.data(), Q_);
  const Eigen::MatrixXd E = (Eigen::MatrixXd(2, 2) << 1.0, 3.0, 0.0, 1.0).finished();
  for (double angle = 0.0; angle < 3.2; angle += 0.1) {
    const Eigen::Vector2d d(std::cos(angle), std::sin(angle));
    const double reach = (E.transpose() * d).norm() + std::abs((E * along).col(0).dot(d)) / 2.0;
    EXPECT_GE(std::sqrt(d.dot(Q_ * d)), reach) << angle;
  }
  EXPECT_LT(std::sqrt(Q_(0, 0)), 1.1 * bounds_(0));
  errors.bounds(3.0, {{1, 0.5}}, workspace_.data(), bounds_);
  EXPECT_NEAR(bounds_(0), 3.0, 1e-6);
}

TEST_F(FlownErrorsTest, KeepAStiffStateApart) {
  A_ << -1e6, 0.0, 0.0, -1.0;
  const FlownErrors errors = this->errors({Eigen::MatrixXd::Identity(2, 2)});
  errors.bounds(1.0, {{0, 1.0}}, workspace_.data(), bounds_);
  EXPECT_LT(bounds_(0), 1e-7);
  EXPECT_NEAR(bounds_(1), std::exp(-1.0), 1e-6);
  EXPECT_GE(bounds_(1), std::exp(-1.0));
}

TEST_F(FlownErrorsTest, AreNotFiniteWhereTheFlowIsNot) {
  A_ << 1.0, 0.0, 0.0, -1.0;
  const FlownErrors errors = this->errors({Eigen::MatrixXd::Identity(2, 2)});
  errors.bounds(1000.0, {{0, 1.0}}, workspace_.data(), bounds_);
  EXPECT_FALSE(std::isfinite(bounds_(0)));
  EXPECT_FALSE(std::isfinite(bounds_(1)));
  errors.ellipsoid(1000.0, {{0, 1.0}}, workspace_.data(), Q_);
  EXPECT_FALSE(Q_.allFinite());
}

TEST_F(FlownErrorsTest, AllowForWhatTheShapesHaveLost) {
  Eigen::MatrixXd R(2, 2);
  R << 1.0, 1.0, 0.0, 0x1p-40;
  const FlownErrors::Shape inverse = inverse_with_rounding(R);
  EXPECT_GE(inverse.rounding(0, 1), 0x1p-12 * 1e-4);
  const FlownErrors::Shape product =
      product_with_rounding(R, Eigen::MatrixXd::Constant(2, 2, 0.5), inverse);
  EXPECT_GE(product.rounding(1, 0), 0.5);
}

}  // namespace
}  // namespace sampled_data_observers::test
