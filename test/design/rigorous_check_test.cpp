// Conditions whose truth is known in closed form, in ball arithmetic.
#include "sampled_data_observers/design/rigorous_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sampled_data_observers/certificate/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kPi = 3.14159265358979323846;

Eigen::MatrixXd matrix2(double a, double b, double c, double d) {
  Eigen::MatrixXd result(2, 2);
  result << a, b, c, d;
  return result;
}

/// e^{[0 1; −1 0] τ}, the rotation by τ.
MatrixExpression rotation() { return exponential(matrix2(0, 1, -1, 0) * time_tau()); }

/// cos τ + level
MatrixExpression cosine(double level) {
  Eigen::MatrixXd first(1, 2);
  first << 1, 0;
  return MatrixExpression(first) * rotation() *
             MatrixExpression(Eigen::MatrixXd(first.transpose())) +
         level;
}

ConditionProof prove_one(const MatrixExpression& expression, double low, double high,
                         const NamedMatrices& values = {}) {
  return prove({{"condition", expression, Condition::Range{low, high}}}, values).front();
}

TEST(RigorousCheck, ProvesABoundOnTheCosineOverManyTurns) {
  const ConditionProof proof = prove_one(cosine(1.001), 0.0, 50.0);
  EXPECT_EQ(proof.status, ProofStatus::kProved) << proof.reason;
  std::printf("intervals %zu\n", proof.intervals);
}

TEST(RigorousCheck, DisprovesWhatFailsBetweenTheValuesOfAGrid) {
  // Below zero on |τ − π| < 1.4e-4 only.
  const ConditionProof proof = prove_one(cosine(1.0 - 1e-8), 0.0, 50.0);
  EXPECT_EQ(proof.status, ProofStatus::kDisproved) << proof.reason;
  std::printf("intervals %zu\n", proof.intervals);
}

TEST(RigorousCheck, LeavesUndecidedWhatIsSingularAtAPoint) {
  const ConditionProof proof = prove_one(cosine(1.0), 0.0, 4.0);
  EXPECT_EQ(proof.status, ProofStatus::kUndecided);
  std::printf("intervals %zu %s\n", proof.intervals, proof.reason.c_str());
}

}  // namespace
}  // namespace sampled_data_observers
