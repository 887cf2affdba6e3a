// Numbers that bounds rest on, where floating point by itself would make them too small.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "certificate/bound_flow.h"
#include "certificate/weighted_norm.h"

namespace sampled_data_observers::test {
namespace {

TEST(BoundFlow, KeepsWhatIsPushedHoweverSlowTheFlowIs) {
  for (const double rate : {1e-12, 1e-17, 1e-300, 1e-308, std::numeric_limits<double>::min(),
                            std::numeric_limits<double>::denorm_min()}) {
    for (const double duration : {1e-9, 1e-3, 1.0, 1000.0}) {
      const double exact = 3.0 + 2.0 * duration;
      for (const double growth : {rate, -rate}) {
        const double flowed = flowed_linearly(3.0, growth, 2.0, duration);
        EXPECT_NEAR(flowed, exact, 1e-8 * exact) << growth << ' ' << duration;
        EXPECT_GE(flowed_linearly(0.0, growth, 2.0, duration),
                  2.0 * duration * (1.0 - rate * duration))
            << growth << ' ' << duration;
      }
      // ẇ = −rate (w − 2 / rate)
      const double decay = decayed(3.0, 2.0 / rate, rate, duration);
      EXPECT_GE(decay, exact * (1.0 - 1e-8)) << rate << ' ' << duration;
    }
  }
}

TEST(WeightedNorm, IsNotLessThanItIsWhereThePIsIllConditioned) {
  Eigen::MatrixXd P(2, 2);
  P << 0.3221563591592804, -0.4673025138020752, -0.4673025138020752, 0.6778436408507196;
  Eigen::MatrixXd A_d(2, 2);
  A_d << 58390.684978690035, -84697.77259274259, 40254.511930225366, -58390.60628187108;
  const double norm = norm_between(P, P, A_d);
  EXPECT_GE(norm, 1.0000012);  // in 60 digits 1.00000124875, by eigenvalues in double 0.90147
  EXPECT_LE(norm, 1e4);
}

TEST(WeightedNorm, IsThatOfExactNumbers) {
  const Eigen::MatrixXd P = Eigen::Vector2d(4.0, 1.0).asDiagonal();
  Eigen::MatrixXd a(2, 2);
  a << 0.0, 3.0, 0.0, 0.0;
  EXPECT_NEAR(norm_between(P, P, a), 6.0, 1e-8);
  EXPECT_GE(norm_between(P, P, a), 6.0);
  EXPECT_NEAR(norm_into(P, a), 6.0, 1e-8);
  EXPECT_EQ(norm_between(P, P, Eigen::MatrixXd(0.0 * P)), 0.0);
  EXPECT_EQ(norm_into(P, Eigen::MatrixXd(2, 0)), 0.0);
}

TEST(WeightedNorm, OfADifferenceThatCancelsIsSmall) {
  const Eigen::MatrixXd P = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::MatrixXd third = P / 3.0;
  const double norm = norm_between(P, P, MatrixExpression(third) - third);
  EXPECT_GT(norm, 0.0);
  EXPECT_LT(norm, 1e-14);
}

}  // namespace
}  // namespace sampled_data_observers::test
