#include "sampled_data_observers/plant/linear_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/allocation_counter.h"
#include "support/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kEps = 2.220446049250313e-16;

/// The transition matrix that the flow applies: its effect on the unit vectors.
Eigen::MatrixXd transition(const Eigen::MatrixXd& A, Duration duration) {
  const Eigen::Index n = A.rows();
  const LinearFlow flow(A, Eigen::MatrixXd::Zero(n, 0));
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd scratch(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    flow.apply(duration, result.col(j).data(), nullptr, scratch.data());
  }
  return result;
}

double relative_error(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  return (found - expected).norm() / expected.norm();
}

const Duration kDurations[] = {0,         1,          63,          64,           1000,
                               999999,    8333333,    33333333,    100000001,    500000000,
                               999999999, 3000000000, 12345678901, 100000000000, 4000000000000};

TEST(LinearFlowTest, NilpotentIsThePolynomial) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = A(1, 2) = 1.0;
  for (const Duration duration : kDurations) {
    const double t = to_seconds(duration);
    Eigen::MatrixXd expected(3, 3);
    expected << 1.0, t, t * t / 2.0, 0.0, 1.0, t, 0.0, 0.0, 1.0;
    EXPECT_LT(relative_error(transition(A, duration), expected), 8 * kEps) << duration;
  }
}

TEST(LinearFlowTest, OscillatingIsTheRotation) {
  const double w = 7.0;
  Eigen::MatrixXd A(2, 2);
  A << 0.0, w, -w, 0.0;
  for (const Duration duration : kDurations) {
    const long double phase = static_cast<long double>(duration) * 1e-9L * 7.0L;
    const auto c = static_cast<double>(std::cos(phase));
    const auto s = static_cast<double>(std::sin(phase));
    Eigen::MatrixXd expected(2, 2);
    expected << c, s, -s, c;
    // One rounding an entry and a digit of the duration: up to seven digits here.
    EXPECT_LT(relative_error(transition(A, duration), expected), 32 * kEps) << duration;
  }
}

TEST(LinearFlowTest, UnstableAndDecayingScalarsKeepTheirRelativePrecision) {
  for (const double a : {1.0, -1.0, 3.5, -40.0}) {
    for (const Duration duration : kDurations) {
      const long double exact =
          std::exp(static_cast<long double>(a) * static_cast<long double>(duration) * 1e-9L);
      if (exact > 1e300L || exact < 1e-300L) continue;
      const double found = transition(Eigen::MatrixXd::Constant(1, 1, a), duration)(0, 0);
      EXPECT_NEAR(1.0, found / static_cast<double>(exact), 16 * kEps) << a << " " << duration;
    }
  }
}

TEST(LinearFlowTest, AStiffPlantKeepsItsSlowMode) {
  // exp(A t) = [e^{-1e6 t}  1e6 (e^{-t} - e^{-1e6 t}) / (1e6 - 1); 0  e^{-t}]
  Eigen::MatrixXd A(2, 2);
  A << -1e6, 1e6, 0.0, -1.0;
  for (const Duration duration : kDurations) {
    const long double t = static_cast<long double>(duration) * 1e-9L;
    if (t > 600.0L) continue;
    const long double fast = std::exp(-1e6L * t);
    const long double slow = std::exp(-t);
    Eigen::MatrixXd expected(2, 2);
    expected << static_cast<double>(fast),
        static_cast<double>(1e6L * (slow - fast) / (1e6L - 1.0L)), 0.0, static_cast<double>(slow);
    EXPECT_LT(relative_error(transition(A, duration), expected), 32 * kEps) << duration;
  }
}

TEST(LinearFlowTest, AgreesWithEigenOnRandomMatrices) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  for (const Eigen::Index n : {1, 2, 4, 6, 15}) {
    for (int trial = 0; trial < 5; ++trial) {
      const Eigen::MatrixXd A =
          Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(generator); });
      for (const Duration duration : {1000000, 77777777, 900000001}) {
        const Eigen::MatrixXd expected = test::exponential(A * to_seconds(duration));
        EXPECT_LT(relative_error(transition(A, duration), expected), 1e-13) << n << " " << duration;
      }
    }
  }
}

TEST(LinearFlowTest, AgreesWithEigenOnEveryKindOfPlant) {
  Eigen::MatrixXd stiff(3, 3);
  stiff << -1e4, 1e4, 0.0, 3.0, -2.0, 1.0, 0.0, 0.5, -0.1;
  Eigen::MatrixXd nilpotent = Eigen::MatrixXd::Zero(3, 3);
  nilpotent(0, 1) = nilpotent(1, 2) = 5.0;
  Eigen::MatrixXd oscillating(3, 3);
  oscillating << 0.0, 3.0, -1.0, -3.0, 0.0, 2.0, 1.0, -2.0, 0.0;
  Eigen::MatrixXd unstable(3, 3);
  unstable << 2.0, 1.0, 0.0, 0.0, 1.0, -1.0, 0.5, 0.0, 3.0;
  for (const Eigen::MatrixXd& A : {stiff, nilpotent, oscillating, unstable}) {
    for (const Duration duration : {1000000, 77777777, 900000001}) {
      const Eigen::MatrixXd scaled = A * to_seconds(duration);
      // What Eigen itself may lose by scaling and squaring grows with the norm.
      const double tolerance = 1e-14 * (10.0 + scaled.norm());
      EXPECT_LT(relative_error(transition(A, duration), test::exponential(scaled)), tolerance) << A;
    }
  }
}

TEST(LinearFlowTest, AConstantInputGivesTheConvolution) {
  // A cart with drag: v' = -k v + u, p' = v.
  const double k = 0.7;
  Eigen::MatrixXd A(2, 2);
  A << 0.0, 1.0, 0.0, -k;
  const Eigen::MatrixXd B = Eigen::Vector2d(0.0, 1.0);
  const LinearFlow flow(A, B);
  for (const Duration duration : {1, 1000, 20000000, 1234567890}) {
    const double t = to_seconds(duration);
    const double u = 2.5;
    Eigen::Vector2d x(1.0, -1.0);
    Eigen::Vector2d scratch;
    flow.apply(duration, x.data(), &u, scratch.data());
    const double decay = -std::expm1(-k * t) / k;
    EXPECT_NEAR(1.0 - decay + u * (t - decay) / k, x(0), 1e-15);
    EXPECT_NEAR(-std::exp(-k * t) + u * decay, x(1), 1e-15);
  }
}

TEST(LinearFlowTest, AConstantIsAnInputThatIsOne) {
  Eigen::MatrixXd A(2, 2);
  A << 0.1, 2.0, -1.5, -0.3;
  const Eigen::Vector2d b(0.4, -0.7);
  const Eigen::Vector2d c(0.2, 1.1);
  Eigen::MatrixXd both(2, 2);
  both << b, c;
  const double u[] = {2.5, 1.0};
  Eigen::Vector2d expected(1.0, -1.0);
  Eigen::Vector2d found = expected;
  Eigen::Vector2d scratch;
  LinearFlow(A, both).apply(123456789, expected.data(), u, scratch.data());
  LinearFlow(A, b, c).apply(123456789, found.data(), u, scratch.data());
  EXPECT_EQ(expected, found);
}

TEST(LinearFlowTest, TheTransitionFlowsEachUnitVector) {
  Eigen::MatrixXd A(2, 2);
  A << 0.1, 2.0, -1.5, -0.3;
  const LinearFlow flow(A, Eigen::MatrixXd::Zero(2, 0));
  Eigen::Matrix2d E;
  Eigen::Vector2d scratch;
  flow.transition(123456789, E.data(), scratch.data());
  for (Eigen::Index j = 0; j < 2; ++j) {
    Eigen::Vector2d x = Eigen::Vector2d::Unit(j);
    flow.apply(123456789, x.data(), nullptr, scratch.data());
    EXPECT_EQ(x, E.col(j));
  }
}

TEST(LinearFlowTest, FlowingInPartsIsFlowingAtOnce) {
  Eigen::MatrixXd A(2, 2);
  A << 0.1, 2.0, -1.5, -0.3;
  const Eigen::MatrixXd whole = transition(A, 1234567890);
  const Eigen::MatrixXd parts = transition(A, 1234000000) * transition(A, 567890);
  EXPECT_LT(relative_error(parts, whole), 8 * kEps);
}

TEST(LinearFlowTest, ResultsDoNotDependOnWhereTheNumbersLie) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(7, 7, [&] { return normal(generator); });
  const LinearFlow flow(A, Eigen::MatrixXd::Zero(7, 0));
  std::vector<double> memory(64);
  std::vector<double> reference;
  for (std::size_t offset = 0; offset < 8; ++offset) {
    for (std::size_t i = 0; i < 7; ++i) memory[offset + i] = 0.1 * static_cast<double>(i + 1);
    flow.apply(123456789, memory.data() + offset, nullptr, memory.data() + 32 + offset);
    const std::vector<double> found(memory.data() + offset, memory.data() + offset + 7);
    if (offset == 0) reference = found;
    EXPECT_EQ(reference, found);
  }
}

TEST(LinearFlowTest, AllocatesNothing) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  const LinearFlow flow(Eigen::MatrixXd::Identity(15, 15), Eigen::MatrixXd::Identity(15, 3));
  Eigen::VectorXd x = Eigen::VectorXd::Ones(15);
  const Eigen::VectorXd u = Eigen::VectorXd::Ones(3);
  Eigen::VectorXd scratch(15);
  const std::size_t before = test::allocations();
  for (const Duration duration : {1, 1000, 20000000, 1234567890}) {
    flow.apply(duration, x.data(), u.data(), scratch.data());
  }
  EXPECT_EQ(before, test::allocations());
}

TEST(LinearFlowTest, RefusesWhatDoesNotFit) {
  const auto zero = [](Eigen::Index rows, Eigen::Index cols) -> Eigen::MatrixXd {
    return Eigen::MatrixXd::Zero(rows, cols);
  };
  EXPECT_THROW(LinearFlow(zero(2, 3), zero(2, 0)), std::invalid_argument);
  EXPECT_THROW(LinearFlow(zero(0, 0), zero(0, 0)), std::invalid_argument);
  EXPECT_THROW(LinearFlow(zero(2, 2), zero(3, 1)), std::invalid_argument);
  EXPECT_THROW(LinearFlow(Eigen::MatrixXd::Constant(1, 1, NAN), zero(1, 0)), std::invalid_argument);
  EXPECT_THROW(LinearFlow(zero(2, 2), zero(2, 1), Eigen::Vector3d::Zero()), std::invalid_argument);
  EXPECT_THROW(LinearFlow(zero(2, 2), zero(2, 1), Eigen::Vector2d(0.0, NAN)),
               std::invalid_argument);
}

}  // namespace
}  // namespace sampled_data_observers
