#include "design/lmi_solver.h"

#include <sys/time.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "design/interior_point.h"
#include "design/packing.h"
#include "design/standard_form.h"
#include "design/workers.h"

namespace sampled_data_observers {
namespace {

/// Of the objective −t of a program without one, which is 0 where an inequality is at its edge.
constexpr double kNoRoom = 1e-8;
/// How exactly the margin of a program without objective is made large.
constexpr double kEnoughOfMargin = 1e-2;

/// How long the other solver may work, and how long it is waited for on a busy machine [s].
constexpr double kSecondOpinion = 0.3;
constexpr double kSecondOpinionPatience = 10.0;

/// Whether the own solver may have missed a solution.
bool is_doubtful(const LmiSolution& solution) {
  return solution.status == SolverStatus::kFailed ||
         (solution.status == SolverStatus::kInaccurate && !solution.satisfies_all());
}

/// Of two solutions, one of them doubtful.
bool is_better(const LmiSolution& other, const LmiSolution& own) {
  if (other.status == SolverStatus::kInfeasible) return own.values.empty();
  if (other.values.empty()) return false;
  if (other.satisfies_all() || own.values.empty()) return true;
  return other.status == SolverStatus::kSolved;
}

std::string packed(const LmiSolution& solution) {
  Packer packer;
  packer.add(static_cast<std::int64_t>(solution.status));
  packer.add(solution.solver);
  packer.add(static_cast<std::int64_t>(solution.return_code));
  packer.add(solution.message);
  packer.add(solution.primal_objective);
  packer.add(solution.dual_objective);
  packer.add(solution.margin);
  packer.add(static_cast<std::int64_t>(solution.violated.size()));
  for (const ViolatedBlock& block : solution.violated) {
    packer.add(block.name);
    packer.add(block.min_eigenvalue);
  }
  packer.add(solution.seconds);
  packer.add(solution.values);
  return packer.bytes();
}

/// Ends this process, which is a worker, when it has worked for so long from now on [s].
void limit_processor_time(double seconds) {
  const double whole = std::floor(seconds);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(whole);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - whole));
  ::setitimer(ITIMER_PROF, &timer, nullptr);
}

LmiSolution unpacked(const std::string& bytes) {
  Unpacker unpacker(bytes);
  LmiSolution solution;
  solution.status = static_cast<SolverStatus>(unpacker.integer());
  solution.solver = unpacker.text();
  solution.return_code = static_cast<int>(unpacker.integer());
  solution.message = unpacker.text();
  solution.primal_objective = unpacker.number();
  solution.dual_objective = unpacker.number();
  solution.margin = unpacker.number();
  for (std::int64_t count = unpacker.integer(); count > 0; --count) {
    const std::string name = unpacker.text();
    solution.violated.push_back({name, unpacker.number()});
  }
  solution.seconds = unpacker.number();
  solution.values = unpacker.matrices();
  return solution;
}

/// Solves with CSDP in a worker process of its own.
/// @param time_limit      [s]
/// @param processor_time  [s], where there is a limit
LmiSolution solve_in_worker(const LmiProgram& program, double time_limit,
                            std::optional<double> processor_time, const SolverOptions& options) {
  WorkerOptions worker;
  worker.time_limit = time_limit;
  const WorkerOutcome outcome = run_in_workers(
                                    1,
                                    [&](std::size_t) {
                                      if (processor_time) limit_processor_time(*processor_time);
                                      return packed(solve_with_csdp(program, options));
                                    },
                                    worker)
                                    .front();
  LmiSolution solution;
  solution.seconds = outcome.seconds;
  switch (outcome.status) {
    case WorkerOutcome::Status::kDone:
      return unpacked(outcome.result);
    case WorkerOutcome::Status::kThrew:
      solution.message = outcome.result;
      break;
    case WorkerOutcome::Status::kTimedOut:
      solution.status = SolverStatus::kTimedOut;
      solution.message = "the solver's process was ended at its time limit";
      break;
    case WorkerOutcome::Status::kCrashed:
      solution.status = SolverStatus::kCrashed;
      solution.message = "the solver's process died";
      break;
  }
  return solution;
}

}  // namespace

const char* to_string(SolverStatus status) {
  switch (status) {
    case SolverStatus::kSolved:
      return "solved";
    case SolverStatus::kInaccurate:
      return "inaccurate";
    case SolverStatus::kInfeasible:
      return "infeasible";
    case SolverStatus::kUnbounded:
      return "unbounded";
    case SolverStatus::kFailed:
      return "failed";
    case SolverStatus::kTimedOut:
      return "timed out";
    case SolverStatus::kCrashed:
      break;
  }
  return "crashed";
}

std::string why_unsolved(const LmiSolution& solution) {
  const bool is_certain =
      solution.status == SolverStatus::kInfeasible ||
      (solution.status == SolverStatus::kSolved && solution.dual_objective >= -kNoRoom);
  if (is_certain) return "has no solution by the solver's account";
  return "was not solved: the solver failed (" + solution.message +
         "), which does not tell whether there is a solution";
}

LmiSolution solve_with_interior_point(const LmiProgram& program, const SolverOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<LmiProgram::Block> blocks = program.compile();
  InteriorPointOptions method;
  if (!program.has_objective()) method.enough = kEnoughOfMargin;
  InteriorPointResult result =
      solve_by_interior_point(standard_form(program, blocks, options), method);
  LmiSolution solution;
  solution.solver = "interior point";
  solution.status = result.status;
  solution.return_code = result.iterations;
  solution.message = std::move(result.message);
  // As CSDP sees it, whose dual program is ours.
  solution.dual_objective = result.objective;
  solution.primal_objective = result.dual_objective;
  take_variables(program, blocks, result.x, solution);
  solution.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

LmiSolution solve_here(const LmiProgram& program, const SolverOptions& options) {
  LmiSolution own = solve_with_interior_point(program, options);
  if (!is_doubtful(own)) return own;
  LmiSolution other = solve_in_worker(program, kSecondOpinionPatience, kSecondOpinion, options);
  return is_better(other, own) ? other : own;
}

LmiSolution solve_lmi(const LmiProgram& program, double time_limit, const SolverOptions& options) {
  return solve_in_worker(program, time_limit, std::nullopt, options);
}

}  // namespace sampled_data_observers
