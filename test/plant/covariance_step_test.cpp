#include "plant/covariance_step.h"

#include <gtest/gtest.h>

#include <vector>

#include "linear_algebra/ordered_linear_algebra.h"
#include "plant/covariance_flow.h"

namespace sampled_data_observers {
namespace {

Eigen::Matrix3d some_F() {
  Eigen::Matrix3d F;
  F << 0.0, 1.0, 0.0, -4.0, -0.3, 0.5, 0.0, 0.2, -2.0;
  return F;
}

Eigen::Matrix3d after_steps(double h, int steps, const Eigen::Matrix3d& F,
                            const Eigen::Matrix3d& Q) {
  Eigen::Matrix3d P = Eigen::Vector3d(2.0, 1.0, 0.5).asDiagonal();
  std::vector<double> workspace(static_cast<std::size_t>(covariance_step_workspace(3)));
  for (int i = 0; i < steps; ++i) {
    covariance_step(F.data(), Q.data(), 3, h, P.data(), workspace.data());
  }
  return P;
}

Eigen::Matrix3d exactly(double seconds, const Eigen::Matrix3d& F, const Eigen::Matrix3d& Q) {
  Eigen::Matrix3d P = Eigen::Vector3d(2.0, 1.0, 0.5).asDiagonal();
  std::vector<double> scratch(static_cast<std::size_t>(CovarianceFlow::scratch_size(3)));
  CovarianceFlow(F, Q).apply(from_seconds(seconds), P.data(), scratch.data());
  return P;
}

TEST(CovarianceStepTest, ConvergesWithTheSecondPowerOfTheStep) {
  const Eigen::Matrix3d Q = Eigen::Vector3d(0.0, 0.4, 0.1).asDiagonal();
  const Eigen::Matrix3d expected = exactly(2.0, some_F(), Q);
  const double coarse = (after_steps(0.02, 100, some_F(), Q) - expected).norm();
  const double fine = (after_steps(0.01, 200, some_F(), Q) - expected).norm();
  EXPECT_LT(coarse, 1e-3 * expected.norm());
  EXPECT_NEAR(4.0, coarse / fine, 0.1);
}

TEST(CovarianceStepTest, WithoutNoiseItIsOfTheFourthOrder) {
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d expected = exactly(2.0, some_F(), none);
  const double coarse = (after_steps(0.02, 100, some_F(), none) - expected).norm();
  const double fine = (after_steps(0.01, 200, some_F(), none) - expected).norm();
  EXPECT_NEAR(16.0, coarse / fine, 1.5);
}

TEST(CovarianceStepTest, StaysSymmetricAndDefiniteForAnyStep) {
  const Eigen::Matrix3d Q = Eigen::Vector3d(0.0, 0.4, 0.1).asDiagonal();
  for (const double h : {1e-6, 0.1, 1.0, 10.0}) {
    Eigen::Matrix3d P = after_steps(h, 5, some_F(), Q);
    EXPECT_EQ(P, Eigen::Matrix3d(P.transpose()));
    EXPECT_TRUE(factor_cholesky(P.data(), 3)) << h;
  }
}

}  // namespace
}  // namespace sampled_data_observers
