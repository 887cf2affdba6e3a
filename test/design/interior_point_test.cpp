#include "design/interior_point.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "design/elimination_order.h"
#include "design/lmi_programs.h"
#include "design/lmi_solver.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kAccuracy = 1e-6;

double least_objective(const LmiProgram& program) {
  const LmiSolution solution = solve_with_interior_point(program);
  EXPECT_EQ(solution.status, SolverStatus::kSolved) << solution.message;
  EXPECT_TRUE(solution.satisfies_all());
  return solution.dual_objective;
}

Eigen::MatrixXd random_symmetric(Eigen::Index n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(
      n, n, [&](Eigen::Index, Eigen::Index) { return normal(random); });
  return A + A.transpose();
}

TEST(InteriorPoint, FindsLargestEigenvalues) {
  std::mt19937 random(1);
  for (Eigen::Index n = 1; n <= 12; ++n) {
    const Eigen::MatrixXd A = random_symmetric(n, random);
    LmiProgram program;
    const MatrixExpression t = program.scalar("t");
    program.bound_above("A <= t I", A, t * identity(n));
    program.minimize(t);
    EXPECT_NEAR(least_objective(program), max_eigenvalue(A), kAccuracy * A.norm()) << n;
  }
}

TEST(InteriorPoint, SolvesLinearPrograms) {
  // The least x + y above three lines, at the corner (1, 2).
  LmiProgram program;
  const MatrixExpression x = program.scalar("x");
  const MatrixExpression y = program.scalar("y");
  program.bound_above("3 x + y >= 5", 5.0, 3.0 * x + y);
  program.bound_above("x + 3 y >= 7", 7.0, x + 3.0 * y);
  program.bound_above("x + 10 >= y", y, x + 10.0);
  program.minimize(x + y);
  const LmiSolution solution = solve_with_interior_point(program);
  EXPECT_NEAR(scalar_value(solution.values, "x"), 1.0, kAccuracy);
  EXPECT_NEAR(scalar_value(solution.values, "y"), 2.0, kAccuracy);
}

TEST(InteriorPoint, FindsTheLeastSolutionOfALyapunovInequality) {
  const Eigen::MatrixXd A = test::stable_plant();
  const Eigen::MatrixXd Q = Eigen::Matrix2d::Identity();
  LmiProgram program;
  const MatrixExpression P = program.symmetric("P", 2);
  program.bound_above("He(P A) <= -Q", He(P * A), Eigen::MatrixXd(-Q));
  const Eigen::MatrixXd row = Eigen::RowVector2d(1.0, 1.0);
  program.minimize(row * P * Eigen::MatrixXd(row.transpose()));
  const LmiSolution solution = solve_with_interior_point(program);
  ASSERT_TRUE(solution.satisfies_all()) << solution.message;
  // That of the equation, which bounds all others from below.
  const Eigen::MatrixXd expected = (Eigen::Matrix2d() << 1.25, 0.25, 0.25, 0.25).finished();
  const Eigen::MatrixXd difference = solution.values.at("P") - expected;
  EXPECT_LT((row * difference * row.transpose())(0, 0), 10.0 * kAccuracy);
}

TEST(InteriorPoint, MinimizesTheL2GainOfALowPass) {
  const LmiSolution solution = solve_with_interior_point(test::low_pass());
  EXPECT_NEAR(scalar_value(solution.values, "gamma"), 0.5, 1e-4);
}

TEST(InteriorPoint, GoesAsFarInsideAsPossibleWithoutObjective) {
  LmiProgram program;
  const MatrixExpression x = program.scalar("x");
  program.require_positive("x > 0", x);
  program.require_positive("x < 1", 1.0 - x);
  const LmiSolution solution = solve_with_interior_point(program);
  EXPECT_NEAR(scalar_value(solution.values, "x"), 0.5, kAccuracy);
  EXPECT_NEAR(solution.margin, 0.5, kAccuracy);
}

TEST(InteriorPoint, TellsThatThereIsNoSolution) {
  EXPECT_EQ(solve_with_interior_point(test::contradiction()).status, SolverStatus::kInfeasible);
  // [x 2; 2 1 - x] >= 0 asks for x (1 - x) >= 4.
  LmiProgram program;
  const MatrixExpression x = program.scalar("x");
  program.bound_above("[x 2; 2 1 - x]", zeros(2, 2), symmetric_blocks({{x, 2.0}, {1.0 - x}}));
  program.minimize(x);
  EXPECT_EQ(solve_with_interior_point(program).status, SolverStatus::kInfeasible);
}

TEST(InteriorPoint, LeavesNoRoomToAnUnstablePlant) {
  const LmiSolution solution =
      solve_with_interior_point(test::lyapunov(Eigen::MatrixXd::Identity(2, 2)));
  EXPECT_FALSE(solution.satisfies_all());
  EXPECT_LE(solution.margin, 1e-6);
  EXPECT_EQ(why_unsolved(solution), "has no solution by the solver's account");
}

TEST(InteriorPoint, TellsThatThereIsNoLeastOne) {
  LmiProgram program;
  const MatrixExpression x = program.scalar("x");
  program.bound_above("x <= 1", x, 1.0);
  program.minimize(x);
  EXPECT_EQ(solve_with_interior_point(program).status, SolverStatus::kUnbounded);
}

TEST(InteriorPoint, EndsForProgramsThatDegenerate) {
  LmiProgram twice;  // only x + y matters
  const MatrixExpression sum = twice.scalar("x") + twice.scalar("y");
  twice.bound_above("1 <= x + y", 1.0, sum);
  twice.minimize(sum);
  EXPECT_NEAR(least_objective(twice), 1.0, kAccuracy);

  LmiProgram flat;  // 0 <= x <= 0
  const MatrixExpression x = flat.scalar("x");
  flat.bound_above("0 <= x", 0.0, x);
  flat.bound_above("x <= 0", x, 0.0);
  flat.minimize(x);
  EXPECT_NEAR(solve_with_interior_point(flat).dual_objective, 0.0, 1e-4);

  LmiProgram far;  // y >= 1/x comes to 0 at infinity only
  const MatrixExpression y = far.scalar("y");
  far.bound_above("[y 1; 1 x]", zeros(2, 2), symmetric_blocks({{y, 1.0}, {far.scalar("x")}}));
  far.minimize(y);
  EXPECT_NEAR(solve_with_interior_point(far).dual_objective, 0.0, 1e-3);

  LmiProgram idle;  // without effect
  idle.scalar("nothing");
  const MatrixExpression z = idle.scalar("z");
  idle.bound_above("2 <= z", 2.0, z);
  idle.minimize(z);
  EXPECT_NEAR(least_objective(idle), 2.0, kAccuracy);
}

/// Σ x_k F_k + F_0 >= 0 with a solution inside, and of the dual one as well, so that both have an
/// optimum.
LmiProgram random_program(std::mt19937& random) {
  std::uniform_int_distribution<int> sizes(1, 8);
  std::normal_distribution<double> normal;
  LmiProgram program;
  const int variables = sizes(random);
  std::vector<MatrixExpression> x;
  std::vector<double> inside;
  for (int k = 0; k < variables; ++k) {
    x.push_back(program.scalar("x" + std::to_string(k)));
    inside.push_back(3.0 * normal(random));
  }
  MatrixExpression objective = 0.0;
  for (int block = 0; block < 3; ++block) {
    const Eigen::Index n = sizes(random);
    Eigen::MatrixXd constant = Eigen::MatrixXd::Identity(n, n);
    MatrixExpression sum = zeros(n, n);
    for (std::size_t k = 0; k < x.size(); ++k) {
      const Eigen::MatrixXd F = random_symmetric(n, random);
      constant -= inside[k] * F;
      sum = sum + x[k] * MatrixExpression(F);
      objective = objective + F.trace() * x[k];
    }
    program.bound_above("block " + std::to_string(block), zeros(n, n),
                        sum + MatrixExpression(constant));
  }
  program.minimize(objective);
  return program;
}

TEST(InteriorPoint, AgreesWithCsdpOnRandomPrograms) {
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    const LmiProgram program = random_program(random);
    const LmiSolution own = solve_with_interior_point(program);
    const LmiSolution other = solve_lmi(program);
    ASSERT_EQ(own.status, SolverStatus::kSolved) << i << ": " << own.message;
    ASSERT_EQ(other.status, SolverStatus::kSolved) << i << ": " << other.message;
    EXPECT_TRUE(own.satisfies_all()) << i;
    EXPECT_NEAR(own.dual_objective, other.dual_objective,
                kAccuracy * (1.0 + std::abs(other.dual_objective)))
        << i;
    EXPECT_LE(own.return_code, 40) << i;
  }
}

TEST(InteriorPoint, FindsTheSameInSeveralThreads) {
  std::mt19937 random(3);
  const LmiProgram program = random_program(random);
  std::vector<LmiSolution> solutions(4);
  std::vector<std::thread> threads;
  for (LmiSolution& solution : solutions) {
    threads.emplace_back([&] { solution = solve_with_interior_point(program); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const LmiSolution& solution : solutions) {
    EXPECT_EQ(solution.values, solutions.front().values);
  }
}

/// x_0 >= 1, and x_k >= 1/x_{k-1} + 1 from cell to cell: each but the last has two neighbours.
TEST(InteriorPoint, SolvesChains) {
  constexpr int kLength = 60;
  LmiProgram program;
  MatrixExpression before = program.scalar("x0");
  MatrixExpression sum = before;
  program.bound_above("1 <= x0", 1.0, before);
  for (int k = 1; k < kLength; ++k) {
    const MatrixExpression next = program.scalar("x" + std::to_string(k));
    program.bound_above("cell", zeros(2, 2), symmetric_blocks({{next - 1.0, 1.0}, {before}}));
    sum = sum + next;
    before = next;
  }
  program.minimize(sum);
  const LmiSolution solution = solve_with_interior_point(program);
  ASSERT_EQ(solution.status, SolverStatus::kSolved) << solution.message;
  EXPECT_TRUE(solution.satisfies_all());
  EXPECT_NEAR(solution.primal_objective, solution.dual_objective, 1e-5 * kLength);
}

TEST(EliminationOrder, FillsInLittleAlongChains) {
  // Groups 1 to 40 in a row, each beside the hub 0.
  std::vector<Eigen::Index> sizes(41, 3);
  std::vector<std::vector<std::size_t>> cliques;
  for (std::size_t g = 1; g < 40; ++g) cliques.push_back({0, g, g + 1});
  const EliminationOrder order = elimination_order(sizes, cliques);
  ASSERT_EQ(order.order.size(), 41u);
  for (const std::vector<std::size_t>& later : order.later) EXPECT_LE(later.size(), 2u);
}

}  // namespace
}  // namespace sampled_data_observers
