// The second solver against closed forms and the first one; skipped where it is not installed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "design/lmi_programs.h"
#include "design/lmi_solver.h"

namespace sampled_data_observers {
namespace {

using test::low_pass;

bool is_installed() { return std::system("command -v sdpa >/dev/null") == 0; }

class Sdpa : public testing::Test {
 protected:
  void SetUp() override {
    if (!is_installed()) GTEST_SKIP() << "the program sdpa is not installed";
  }
};

TEST_F(Sdpa, FindsTheL2GainOfALowPass) {
  const LmiSolution solution = solve_with_sdpa(low_pass());
  ASSERT_TRUE(solution.satisfies_all()) << solution.message;
  EXPECT_NEAR(scalar_value(solution.values, "gamma"), 0.5, 1e-4);
  EXPECT_NEAR(solution.dual_objective, solve_lmi(low_pass()).dual_objective, 1e-6);
}

TEST_F(Sdpa, FindsTheSameMarginAsTheOtherSolver) {
  const LmiProgram program = test::lyapunov(test::stable_plant());
  const LmiSolution other = solve_lmi(program);
  const LmiSolution solution = solve_with_sdpa(program);
  ASSERT_TRUE(solution.satisfies_all()) << solution.message;
  EXPECT_NEAR(solution.margin, other.margin, 1e-5);
  EXPECT_NEAR(solution.dual_objective, other.dual_objective, 1e-5);
}

TEST_F(Sdpa, TellsContradictions) {
  EXPECT_EQ(solve_with_sdpa(test::contradiction()).status, SolverStatus::kInfeasible);
}

TEST_F(Sdpa, IsEndedAtItsTimeLimit) {
  const LmiSolution solution = solve_with_sdpa(low_pass(), 0.0);
  EXPECT_EQ(solution.status, SolverStatus::kTimedOut);
  EXPECT_TRUE(solution.values.empty());
}

TEST(SdpaProgram, IsWrittenWithTheNamesOfItsVariablesAndBlocks) {
  std::istringstream lines(sdpa_problem(test::lyapunov(test::stable_plant())));
  std::vector<std::string> comments;
  std::string line;
  while (std::getline(lines, line) && line.front() == '*') comments.push_back(line);
  ASSERT_EQ(comments.size(), 6U);
  EXPECT_EQ(comments[1], "* x1 to x3: P, 2 x 2, symmetric: its lower triangle");
  EXPECT_EQ(comments[2], "* x4: how far the solution is inside the strict blocks");
  EXPECT_EQ(comments[3], "* block 1: P > 0");
  EXPECT_EQ(line, "4");  // variables; then blocks, of which the last bounds x4
  std::getline(lines, line);
  EXPECT_EQ(line, "4");
}

TEST(SdpaProgram, IsAskedForWhereItIsMissing) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nonexistent", 1);
  const LmiSolution solution = solve_with_sdpa(low_pass());
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(solution.status, SolverStatus::kFailed);
  EXPECT_NE(solution.message.find("Debian's package sdpa"), std::string::npos) << solution.message;
}

}  // namespace
}  // namespace sampled_data_observers
