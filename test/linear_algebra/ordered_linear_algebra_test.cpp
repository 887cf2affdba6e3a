#include "linear_algebra/ordered_linear_algebra.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstring>
#include <limits>
#include <vector>

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index cols) {
  return Eigen::MatrixXd::Random(rows, cols);
}

Eigen::MatrixXd lower(const Eigen::MatrixXd& M) { return M.triangularView<Eigen::Lower>(); }

TEST(OrderedLinearAlgebraTest, ProductsAreEigens) {
  const Eigen::MatrixXd A = random(3, 5);
  const Eigen::MatrixXd B = random(5, 4);
  const Eigen::MatrixXd D = random(4, 5);
  Eigen::MatrixXd C(3, 4);
  multiply(A.data(), 3, 5, B.data(), 4, C.data());
  EXPECT_LT((C - A * B).norm(), 1e-14);
  multiply_by_transposed(A.data(), 3, 5, D.data(), 4, C.data());
  EXPECT_LT((C - A * D.transpose()).norm(), 1e-14);
  EXPECT_NEAR(A.row(0).transpose().eval().dot(B.col(1)),
              dot(A.row(0).transpose().eval().data(), B.col(1).eval().data(), 5), 1e-15);
}

TEST(OrderedLinearAlgebraTest, ASymmetricProductIsSymmetricToTheBit) {
  const Eigen::MatrixXd Phi = random(4, 4);
  const Eigen::MatrixXd root = random(4, 4);
  Eigen::MatrixXd P = root * root.transpose();
  mirror_lower(P.data(), 4);
  EXPECT_EQ(P, P.transpose());
  const Eigen::MatrixXd left = Phi * P;
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(4, 4);
  add_symmetric_product(left.data(), Phi.data(), 4, 4, C.data());
  EXPECT_EQ(C, C.transpose());
  EXPECT_LT((C - Eigen::MatrixXd::Identity(4, 4) - Phi * P * Phi.transpose()).norm(), 1e-13);
}

TEST(OrderedLinearAlgebraTest, CholeskyFindsTheFactorAndWhatHasNone) {
  const Eigen::MatrixXd root = random(5, 5) + 3.0 * Eigen::MatrixXd::Identity(5, 5);
  const Eigen::MatrixXd P = root * root.transpose();
  Eigen::MatrixXd L = P;
  ASSERT_TRUE(factor_cholesky(L.data(), 5));
  EXPECT_EQ(L, lower(L));
  EXPECT_LT((L * L.transpose() - P).norm(), 1e-13 * P.norm());

  Eigen::MatrixXd singular = Eigen::MatrixXd::Ones(2, 2);
  EXPECT_FALSE(factor_cholesky(singular.data(), 2));
  Eigen::MatrixXd indefinite = Eigen::Vector2d(1.0, -1.0).asDiagonal();
  EXPECT_FALSE(factor_cholesky(indefinite.data(), 2));
  Eigen::MatrixXd not_finite = Eigen::MatrixXd::Identity(2, 2);
  not_finite(1, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(factor_cholesky(not_finite.data(), 2));
  // Definiteness does not depend on the units.
  Eigen::MatrixXd scaled = Eigen::Vector2d(1e30, 1e-30).asDiagonal();
  EXPECT_TRUE(factor_cholesky(scaled.data(), 2));
  // What is nearly singular is refused from a tolerance on.
  Eigen::MatrixXd nearly(2, 2);
  nearly << 1.0, 1.0, 1.0, 1.0 + 1e-6;
  Eigen::MatrixXd again = nearly;
  EXPECT_TRUE(factor_cholesky(nearly.data(), 2, 1e-7));
  EXPECT_FALSE(factor_cholesky(again.data(), 2, 1e-5));
}

TEST(OrderedLinearAlgebraTest, GramFactorIsTheCholeskyFactorOfTheProduct) {
  const Eigen::MatrixXd M = random(6, 4);
  Eigen::MatrixXd work = M;
  Eigen::MatrixXd L(4, 4);
  ASSERT_TRUE(factor_gram(work.data(), 6, 4, L.data()));
  EXPECT_EQ(L, lower(L));
  EXPECT_LT((L * L.transpose() - M.transpose() * M).norm(), 1e-13);
  Eigen::MatrixXd dependent = M;
  dependent.col(3) = M.col(0) - 2.0 * M.col(1);
  EXPECT_FALSE(factor_gram(dependent.data(), 6, 4, L.data()));
  Eigen::MatrixXd not_finite = M;
  not_finite(2, 1) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(factor_gram(not_finite.data(), 6, 4, L.data()));
}

TEST(OrderedLinearAlgebraTest, TriangularSystemsAreSolvedInsideALargerMatrix) {
  const Eigen::MatrixXd whole = lower(random(5, 5) + 4.0 * Eigen::MatrixXd::Identity(5, 5));
  const Eigen::MatrixXd L = whole.topLeftCorner(3, 3);
  const Eigen::MatrixXd B = random(3, 2);
  Eigen::MatrixXd X = B;
  solve_lower(whole.data(), 5, 3, X.data(), 2);
  EXPECT_LT((L * X - B).norm(), 1e-14);
  X = B;
  solve_lower_transposed(whole.data(), 5, 3, X.data(), 2);
  EXPECT_LT((L.transpose() * X - B).norm(), 1e-14);
}

TEST(OrderedLinearAlgebraTest, BitsDoNotDependOnAlignment) {
  constexpr Eigen::Index kSize = 7;
  const Eigen::MatrixXd root = random(kSize, kSize);
  const Eigen::MatrixXd P = root * root.transpose() + Eigen::MatrixXd::Identity(kSize, kSize);
  std::vector<double> expected;
  for (std::size_t shift = 0; shift < 8; ++shift) {
    constexpr std::size_t kEntries = kSize * kSize;
    std::vector<double> memory(shift + 4 * kEntries);
    double* L = memory.data() + shift;
    double* product = L + kEntries;
    double* solved = product + kEntries;
    double* symmetric = solved + kEntries;
    std::memcpy(L, P.data(), kEntries * sizeof(double));
    ASSERT_TRUE(factor_cholesky(L, kSize));
    multiply(L, kSize, kSize, root.data(), kSize, product);
    std::memcpy(solved, product, kEntries * sizeof(double));
    solve_lower(L, kSize, kSize, solved, kSize);
    solve_lower_transposed(L, kSize, kSize, solved, kSize);
    add_symmetric_product(product, L, kSize, kSize, symmetric);
    const std::vector<double> found(memory.begin() + static_cast<std::ptrdiff_t>(shift),
                                    memory.end());
    if (shift == 0) expected = found;
    EXPECT_EQ(0, std::memcmp(expected.data(), found.data(), found.size() * sizeof(double)));
  }
}

}  // namespace
}  // namespace sampled_data_observers
