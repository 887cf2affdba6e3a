// The polynomials enclose what they stand for, on intervals so long that their remainders count.
#include "design/taylor_matrix.h"

#include <gtest/gtest.h>

#include <random>

#include "certificate/evaluate_expression.h"

namespace sampled_data_observers {
namespace {

constexpr slong kPrecision = 128;
constexpr double kCentre = 0.75;
constexpr double kRadius = 1.0;

Eigen::MatrixXd random_matrix(Eigen::Index n, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> entries(-1.0, 1.0);
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index i = 0; i < result.size(); ++i) result.data()[i] = entries(generator);
  return result;
}

std::vector<BallMatrix> evaluated(const TaylorAlgebra& algebra,
                                  const MatrixExpression& expression) {
  TaylorAlgebra own = algebra;
  return ExpressionEvaluator<TaylorAlgebra>(own).evaluate(expression).coefficients;
}

/// Compares with the expression at points of the interval, where only rounding widens it.
void expect_enclosed(const MatrixExpression& expression) {
  const NamedMatrices values = {{"a", scalar_matrix(0.3)}};
  const TaylorAlgebra over_interval(values, kCentre, kRadius, kPrecision);
  const std::vector<BallMatrix> coefficients = evaluated(over_interval, expression);
  ASSERT_GT(coefficients.size(), 1u);
  const BallMatrix range = over_interval.range(coefficients);
  ASSERT_TRUE(midpoints(range).allFinite());
  for (int i = -16; i <= 16; ++i) {
    const double h = kRadius * i / 16.0;
    SCOPED_TRACE(h);
    const BallMatrix exact =
        evaluated(TaylorAlgebra(values, kCentre + h, 0.0, kPrecision), expression).front();
    BallMatrix polynomial(expression.rows(), expression.cols());
    for (std::size_t k = coefficients.size(); k-- > 0;) {
      Ball step;
      arb_set_d(step.get(), h);
      polynomial = sum(scaled(step.get(), polynomial, kPrecision), coefficients[k], kPrecision);
    }
    EXPECT_NE(arb_mat_overlaps(polynomial.get(), exact.get()), 0);
    EXPECT_NE(arb_mat_overlaps(range.get(), exact.get()), 0);
  }
}

TEST(TaylorMatrix, EnclosesExponentials) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const MatrixExpression A = random_matrix(3, seed);
    expect_enclosed(exponential(time_tau() * A));
    expect_enclosed(transpose(exponential(-(A * (symbol("a") - time_tau())))));
    expect_enclosed(exponential(transpose(time_tau() * (time_tau() * A))));
    expect_enclosed(exponential(time_tau() * A + random_matrix(3, seed + 100)));
  }
  expect_enclosed(exponential(symbol("a") * time_tau() + square("a")));
}

TEST(TaylorMatrix, EnclosesInverses) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    // Diagonally dominant on the whole interval.
    const MatrixExpression A = random_matrix(3, seed);
    expect_enclosed(inverse(12.0 * identity(3) + time_tau() * A));
    expect_enclosed(inverse(40.0 * identity(3) + exponential(time_tau() * A)));
  }
}

TEST(TaylorMatrix, EnclosesProductsOfHighDegree) {
  const MatrixExpression A = random_matrix(2, 7);
  MatrixExpression power = identity(2) + time_tau() * A;
  for (int i = 0; i < 3; ++i) power = power * power;
  expect_enclosed(power);
  expect_enclosed(blocks({{power, time_tau() * power}}));
}

TEST(TaylorMatrix, IsNarrowOnShortIntervals) {
  const double radius = 1e-3;
  const NamedMatrices none;
  const TaylorAlgebra algebra(none, kCentre, radius, kPrecision);
  const auto coefficients =
      evaluated(algebra, exponential(time_tau() * MatrixExpression(random_matrix(3, 1))));
  // Fifth order: the last coefficient varies by no more than the next would add.
  Ball width;
  arb_get_rad_arb(width.get(), coefficients.back().entry(0, 0));
  EXPECT_LT(arf_get_d(arb_midref(width.get()), ARF_RND_UP), 10.0 * radius);
}

}  // namespace
}  // namespace sampled_data_observers
