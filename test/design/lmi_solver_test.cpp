#include "design/lmi_solver.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "design/lmi_programs.h"
#include "design/workers.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

TEST(LmiSolver, FindsALyapunovMatrixOfAStablePlant) {
  const Eigen::MatrixXd A = test::stable_plant();
  const LmiSolution solution = solve_lmi(test::lyapunov(A));
  EXPECT_EQ(solution.status, SolverStatus::kSolved) << solution.message;
  ASSERT_TRUE(solution.satisfies_all());
  EXPECT_GT(solution.margin, 0.01);
  const Eigen::MatrixXd& found = solution.values.at("P");
  EXPECT_LT(max_eigenvalue(found * A + A.transpose() * found), 0.0);
}

TEST(LmiSolver, NamesTheBlockThatAnUnstablePlantViolates) {
  const LmiSolution solution = solve_lmi(test::lyapunov(Eigen::MatrixXd::Identity(1, 1)));
  EXPECT_FALSE(solution.satisfies_all());
  EXPECT_LE(solution.margin, 1e-6);
  EXPECT_FALSE(solution.violated.empty());
}

TEST(LmiSolver, MinimizesTheL2GainOfALowPass) {
  const LmiSolution solution = solve_lmi(test::low_pass());
  ASSERT_EQ(solution.status, SolverStatus::kSolved) << solution.message;
  EXPECT_NEAR(scalar_value(solution.values, "gamma"), 0.5, 1e-4);
}

TEST(LmiSolver, TellsContradictions) {
  EXPECT_EQ(solve_lmi(test::contradiction()).status, SolverStatus::kInfeasible);
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
