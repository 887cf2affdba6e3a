#include "plant/differentiation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sampled_data_observers/plant/expression_map.h"
#include "support/allocation_counter.h"

namespace sampled_data_observers {
namespace {

const ExpressionMap kMap({{"x1", "x2"}, {"u"}, {}}, {},
                         {{"f", "sin(x1)*x2"}, {"g", "x1^3 + u*x2"}, {"h", "x2"}});

Eigen::MatrixXd jacobian(const Eigen::Vector2d& x, double u, const Eigen::VectorXd& scales) {
  Eigen::MatrixXd J(3, 2);
  Eigen::VectorXd workspace(2 + 2 * 3);
  const std::size_t before = test::allocations();
  differentiate(kMap, x.data(), &u, scales, J.data(), workspace.data());
  if (test::allocations_are_counted()) {
    EXPECT_EQ(before, test::allocations());
  }
  return J;
}

TEST(DifferentiationTest, GivesTheDerivativesByStatesToNineDigits) {
  const Eigen::Vector2d x(0.7, -3.0);
  Eigen::MatrixXd exact(3, 2);
  exact << std::cos(x(0)) * x(1), std::sin(x(0)), 3.0 * x(0) * x(0), 2.0, 0.0, 1.0;
  const Eigen::MatrixXd J = jacobian(x, 2.0, Eigen::Vector2d::Ones());
  for (Eigen::Index i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(exact(i), J(i), 1e-9 * (1.0 + std::abs(exact(i)))) << i;
  }
}

TEST(DifferentiationTest, ScalesSayHowFarToLookWhereAStateIsZero) {
  // x³ between -h and h has the slope h².
  const auto slope = [](double scale) {
    return jacobian(Eigen::Vector2d::Zero(), 0.0, Eigen::Vector2d(scale, 1.0))(1, 0);
  };
  EXPECT_NEAR(1.0, slope(1e-3) / (slope(1.0) * 1e-6), 1e-9);
}

}  // namespace
}  // namespace sampled_data_observers
