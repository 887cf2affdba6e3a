#include "sampled_data_observers/design/lmi_solver.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/design/workers.h"

namespace sampled_data_observers {
namespace {

TEST(LmiSolver, FindsALyapunovMatrixOfAStablePlant) {
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, -2, -3;
  LmiProgram program;
  const MatrixExpression P = program.symmetric("P", 2);
  program.require_positive("P > 0", P);
  program.require_negative("He(P A) < 0", He(P * A));
  program.bound_above("P <= I", P, identity(2));
  const LmiSolution solution = solve_lmi(program);
  EXPECT_EQ(solution.status, SolverStatus::kSolved) << solution.message;
  ASSERT_TRUE(solution.satisfies_all());
  EXPECT_GT(solution.margin, 0.01);
  const Eigen::MatrixXd& found = solution.values.at("P");
  EXPECT_LT(max_eigenvalue(found * A + A.transpose() * found), 0.0);
}

TEST(LmiSolver, NamesTheBlockThatAnUnstablePlantViolates) {
  LmiProgram program;
  const MatrixExpression P = program.symmetric("P", 1);
  program.require_positive("P > 0", P);
  program.require_negative("He(P A) < 0", He(P * 1.0));
  program.bound_above("P <= I", P, identity(1));
  const LmiSolution solution = solve_lmi(program);
  EXPECT_FALSE(solution.satisfies_all());
  EXPECT_LE(solution.margin, 1e-6);
  EXPECT_FALSE(solution.violated.empty());
}

TEST(LmiSolver, MinimizesTheL2GainOfALowPass) {
  // dx/dt = -2 x + w, y = x: the gain is 1/2.
  LmiProgram program;
  const MatrixExpression P = program.scalar("P");
  const MatrixExpression mu = program.squared("gamma");
  program.require_positive("P > 0", P);
  program.require_negative("bounded real lemma", symmetric_blocks({{-4.0 * P + 1.0, P}, {-mu}}));
  program.minimize(mu);
  const LmiSolution solution = solve_lmi(program);
  ASSERT_EQ(solution.status, SolverStatus::kSolved) << solution.message;
  EXPECT_NEAR(scalar_value(solution.values, "gamma"), 0.5, 1e-4);
}

TEST(LmiSolver, TellsContradictions) {
  LmiProgram program;
  const MatrixExpression x = program.scalar("x");
  program.bound_above("x <= 1", x, 1.0);
  program.bound_above("2 <= x", 2.0, x);
  program.minimize(x);
  EXPECT_EQ(solve_lmi(program).status, SolverStatus::kInfeasible);
}

TEST(Workers, LoseOnlyTheTasksThatHangCrashOrThrow) {
  WorkerOptions options;
  options.jobs = 2;
  options.time_limit = 0.5;
  std::size_t reported = 0;
  options.on_outcome = [&](std::size_t, const WorkerOutcome&) { ++reported; };
  const auto task = [](std::size_t i) -> std::string {
    if (i == 1) {
      for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
    }
    if (i == 3) std::abort();
    if (i == 5) throw std::runtime_error("no solution");
    return std::to_string(i * i);
  };
  const std::vector<WorkerOutcome> outcomes = run_in_workers(8, task, options);
  ASSERT_EQ(outcomes.size(), 8u);
  EXPECT_EQ(reported, 8u);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    using Status = WorkerOutcome::Status;
    const Status expected = i == 1   ? Status::kTimedOut
                            : i == 3 ? Status::kCrashed
                            : i == 5 ? Status::kThrew
                                     : Status::kDone;
    EXPECT_EQ(outcomes[i].status, expected) << i;
    if (expected == Status::kDone) {
      EXPECT_EQ(outcomes[i].result, std::to_string(i * i));
    }
  }
  EXPECT_EQ(outcomes[5].result, "no solution");
}

}  // namespace
}  // namespace sampled_data_observers
