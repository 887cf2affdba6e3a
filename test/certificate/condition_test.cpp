// The floating-point check of conditions on matrices whose definiteness is known exactly: built of
// whole numbers, of powers of two, and of formulas that are zero.
#include "certificate/condition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "certified_gains.h"

namespace sampled_data_observers::test {
namespace {

using Random = std::mt19937_64;

bool accepts(const MatrixExpression& expression) {
  return check({{"condition", expression, std::nullopt}}, {}).front().holds();
}

int whole(Random& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}

Eigen::MatrixXd whole_numbers(Random& random, Eigen::Index rows, Eigen::Index cols, int size) {
  return Eigen::MatrixXd::NullaryExpr(
      rows, cols, [&](auto, auto) { return static_cast<double>(whole(random, -size, size)); });
}

Eigen::MatrixXd gaussian(Random& random, Eigen::Index rows, Eigen::Index cols) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&](auto, auto) { return normal(random); });
}

/// A diagonal of powers of two.
Eigen::MatrixXd scales(Random& random, Eigen::Index n, int exponent) {
  Eigen::VectorXd diagonal(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    diagonal(i) = std::ldexp(1.0, whole(random, -exponent, exponent));
  }
  return diagonal.asDiagonal();
}

TEST(Condition, NeverAcceptsASingularMatrixOfWholeNumbersHoweverScaled) {
  Random random(1);
  for (int run = 0; run < 2000; ++run) {
    const Eigen::Index n = whole(random, 2, 7);
    // Of rank n − 1, exactly.
    const Eigen::MatrixXd B = whole_numbers(random, n, n - 1, 1000);
    const Eigen::MatrixXd D = scales(random, n, 40);
    EXPECT_FALSE(accepts(Eigen::MatrixXd(D * (B * B.transpose()) * D))) << run;
    const MatrixExpression formula =
        MatrixExpression(D) * (MatrixExpression(B) * transpose(MatrixExpression(B))) * D;
    EXPECT_FALSE(accepts(formula)) << run;
    // A little below.
    EXPECT_FALSE(accepts(formula - std::ldexp(1.0, -60) * MatrixExpression(D) * D)) << run;
  }
}

TEST(Condition, AcceptsAPositiveDefiniteMatrixHoweverScaled) {
  Random random(2);
  for (int run = 0; run < 500; ++run) {
    const Eigen::Index n = whole(random, 1, 7);
    const Eigen::MatrixXd B = whole_numbers(random, n, n, 10);
    const Eigen::MatrixXd D = scales(random, n, 300);
    const Eigen::MatrixXd M = B * B.transpose() + Eigen::MatrixXd::Identity(n, n);
    EXPECT_TRUE(accepts(MatrixExpression(D) * M * D)) << run;
    const double least = check({{"", M, std::nullopt}}, {}).front().min_eigenvalue;
    EXPECT_NEAR(check({{"", Eigen::MatrixXd(D * M * D), std::nullopt}}, {}).front().min_eigenvalue,
                least, 1e-12);
  }
}

TEST(Condition, SeesWhatCancellationHides) {
  Random random(3);
  for (int run = 0; run < 2000; ++run) {
    const Eigen::Index n = whole(random, 2, 6);
    const Eigen::MatrixXd B = whole_numbers(random, n, n - 1, 30);
    const MatrixExpression singular = Eigen::MatrixXd(B * B.transpose());
    const double size = std::pow(10.0, whole(random, -3, 14));
    const Eigen::MatrixXd X = size * gaussian(random, n, n);
    const MatrixExpression large = He(MatrixExpression(X));
    // Both are the singular matrix, and come out with the rounding of the large one.
    EXPECT_FALSE(accepts((singular + large) - large)) << run;
    EXPECT_FALSE(accepts(large + (singular - large))) << run;
  }
}

TEST(Condition, NeverTakesTheRoundingOfAFormulaThatIsZeroForItsSign) {
  Random random(4);
  for (int run = 0; run < 1000; ++run) {
    const Eigen::Index n = whole(random, 1, 6);
    const double size = std::pow(10.0, std::uniform_real_distribution<double>(-3.0, 1.3)(random));
    const Eigen::MatrixXd D = scales(random, n, 10);
    const Eigen::MatrixXd A =
        size * (D * gaussian(random, n, n) * D.diagonal().cwiseInverse().asDiagonal());
    const MatrixExpression flow = exponential(A);
    for (const MatrixExpression& zero :
         {flow * exponential(-MatrixExpression(A)) - identity(n),
          exponential(MatrixExpression(A) + A) - flow * flow,
          inverse(A) * MatrixExpression(A) - identity(n),
          (identity(n) + A) * A - (MatrixExpression(A) + MatrixExpression(A) * A)}) {
      EXPECT_FALSE(accepts(He(zero))) << run << '\n' << A;
      EXPECT_FALSE(accepts(-He(zero))) << run << '\n' << A;
    }
  }
}

TEST(Condition, IsRefutedByADiagonalEntryThatIsNotPositive) {
  Eigen::MatrixXd M = 1e9 * Eigen::MatrixXd::Identity(3, 3);
  EXPECT_TRUE(accepts(M));
  M(1, 1) = 0.0;
  EXPECT_FALSE(accepts(M));
  M(1, 1) = -1e-300;
  EXPECT_FALSE(accepts(M));
  M(1, 1) = std::nan("");
  EXPECT_FALSE(accepts(M));
  M(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(accepts(M));
}

TEST(Condition, HasDomainsThatHoldUpToTheirEnds) {
  const auto holds = [](const Condition& condition, double value) {
    return check({condition}, {{"x", scalar_matrix(value)}}).front().holds();
  };
  EXPECT_TRUE(holds(positive("x"), 1e-300));
  EXPECT_FALSE(holds(positive("x"), 0.0));
  EXPECT_FALSE(holds(positive("x"), -1e-300));
  EXPECT_TRUE(holds(not_negative("x"), 0.0));
  EXPECT_FALSE(holds(not_negative("x"), -1e-300));
  EXPECT_FALSE(holds(not_negative("x"), std::nan("")));
}

TEST(Condition, IsNotAboutTimesInWrongOrder) {
  EXPECT_TRUE(all_hold(check(domain_of_times(0.2, 0.2), {})));
  EXPECT_TRUE(all_hold(check(domain_of_times(0.0, 0.1), {})));
  EXPECT_FALSE(all_hold(check(domain_of_times(0.2, 0.1), {})));
  EXPECT_FALSE(all_hold(check(domain_of_times(-0.1, 0.1), {})));
  EXPECT_FALSE(all_hold(check(domain_of_times(0.0, 0.0), {})));
  EXPECT_FALSE(all_hold(check({{"", identity(2), Condition::Range{0.2, 0.1}}}, {})));
}

/// The values once came out of a search for the largest T2, with a gamma of 4.9e9. In 80 digits
/// −M(0) has the diagonal entry −0.97.
TEST(Condition, RefusesAnIllScaledCertificateThatIsFalse) {
  const CertifiedGains gains("test/design/false_certificates/ferrante2019_oscillator_max_T2.yaml");
  const std::string violations = describe_violations(check(gains.certificate()));
  EXPECT_NE(violations.find("<= 0, ferrante2019 (28) is violated by "), std::string::npos)
      << violations;
  EXPECT_THROW(gains.config(), ConfigError);
}

}  // namespace
}  // namespace sampled_data_observers::test
