#include "design/lmi_solver.h"

#include "design/packing.h"
#include "design/workers.h"

namespace sampled_data_observers {
namespace {

/// Of the objective −t of a program without one, which is 0 where an inequality is at its edge.
constexpr double kNoRoom = 1e-9;

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

LmiSolution solve_lmi(const LmiProgram& program, double time_limit, const SolverOptions& options) {
  WorkerOptions worker;
  worker.time_limit = time_limit;
  const WorkerOutcome outcome =
      run_in_workers(
          1, [&](std::size_t) { return packed(solve_with_csdp(program, options)); }, worker)
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

}  // namespace sampled_data_observers
