#include "design/threads.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

#include "design/interior_point.h"
#include "design/lmi_solver.h"
#include "design/work_limit.h"
#include "lmi_programs.h"

namespace sampled_data_observers {
namespace {

TEST(Threads, LoseOnlyTheTasksThatThrowOrTakeTooLong) {
  ThreadOptions options;
  options.jobs = 3;
  options.time_limit = 0.2;
  std::size_t reported = 0;
  options.on_done = [&] { ++reported; };
  std::vector<std::size_t> results(8, 0);
  const auto task = [&](std::size_t i) {
    while (i == 1) require_time_left();
    if (i == 5) throw std::runtime_error("no solution");
    results[i] = i * i;
  };
  const std::vector<ThreadOutcome> outcomes = run_in_threads(8, task, options);
  EXPECT_EQ(reported, 8u);
  ASSERT_EQ(outcomes.size(), 8u);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    using Status = ThreadOutcome::Status;
    const Status expected = i == 1 ? Status::kTimedOut : i == 5 ? Status::kThrew : Status::kDone;
    EXPECT_EQ(outcomes[i].status, expected) << i;
    EXPECT_EQ(results[i], expected == Status::kDone ? i * i : 0) << i;
  }
  EXPECT_EQ(outcomes[5].message, "no solution");
  require_time_left();  // no limit is left
}

TEST(Threads, EndASolverAtItsTimeLimit) {
  ThreadOptions options;
  options.time_limit = 0.0;
  const auto task = [](std::size_t) { solve_with_interior_point(test::low_pass()); };
  EXPECT_EQ(run_in_threads(1, task, options)[0].status, ThreadOutcome::Status::kTimedOut);
}

TEST(Threads, SolveByBothSolversAtATimeWithTheBitsOfOne) {
  ThreadOptions options;
  options.jobs = 4;
  options.time_limit = 60.0;
  const LmiProgram program = test::low_pass();
  const auto gammas = [&](unsigned jobs) {
    options.jobs = jobs;
    std::vector<double> values(8, 0.0);
    run_in_threads(
        values.size(),
        [&](std::size_t i) {
          const LmiSolution solution =
              i % 2 == 0 ? solve_lmi(program) : solve_with_interior_point(program);
          values[i] = scalar_value(solution.values, "gamma");
        },
        options);
    return values;
  };
  const std::vector<double> alone = gammas(1);
  EXPECT_NEAR(alone[0], 0.5, 1e-4);
  EXPECT_NEAR(alone[1], 0.5, 1e-4);
  EXPECT_EQ(gammas(4), alone);
}

}  // namespace
}  // namespace sampled_data_observers
