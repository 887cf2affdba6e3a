#pragma once

#include <string>
#include <vector>

#include "design/lmi_program.h"

namespace sampled_data_observers {

/// What a solver said of a program. It is never enough to accept a design: that takes a check of
/// the theorem's own inequalities.
enum class SolverStatus {
  kSolved,
  kInaccurate,  ///< stopped before its tolerances, with a solution that may do
  kInfeasible,
  kUnbounded,
  kFailed,
  kTimedOut,  ///< its process was ended at the time limit
  kCrashed    ///< its process died
};
const char* to_string(SolverStatus status);

struct ViolatedBlock {
  std::string name;
  double min_eigenvalue = 0.0;
};

struct LmiSolution {
  SolverStatus status = SolverStatus::kFailed;
  std::string solver;   ///< name and version
  int return_code = 0;  ///< the solver's own
  std::string message;  ///< what the code means, or why there is none
  /// The program is the dual one in the solver's eyes: this is its objective …
  double dual_objective = 0.0;
  /// … and this bounds it from below.
  double primal_objective = 0.0;
  /// Least eigenvalue of all strict blocks: how far inside the solution is.
  double margin = 0.0;
  std::vector<ViolatedBlock> violated;
  double seconds = 0.0;
  /// The decision variables, whatever the status; empty where the solver left none.
  NamedMatrices values;

  /// Whether there are values that satisfy all blocks.
  bool satisfies_all() const { return !values.empty() && violated.empty(); }
};

/// Why a solution does not satisfy all, for a message that goes on from the name of the
/// inequalities: that there is none, if the solver is certain of it, or that the solver failed,
/// which does not tell.
std::string why_unsolved(const LmiSolution& solution);

struct SolverOptions {
  /// How far strict blocks are kept from singular where there is an objective.
  double margin = 1e-7;
};

/// Solves with the package's own interior point method (interior_point.h), in the calling thread;
/// several may run at a time.
LmiSolution solve_with_interior_point(const LmiProgram& program, const SolverOptions& options = {});

/// Solves with the own method and, where that leaves in doubt whether there is a solution, with
/// CSDP as a second opinion, in a worker process of its own, where it may work for 0.3 s. The
/// better solution of the two is given.
LmiSolution solve_here(const LmiProgram& program, const SolverOptions& options = {});

/// Solves in the calling process with CSDP, which is not thread-safe, may loop for ever, and writes
/// to standard output: to be called in a worker process only (see workers.h).
LmiSolution solve_with_csdp(const LmiProgram& program, const SolverOptions& options);

/// Solves with the program `sdpa`, of the Debian package of this name, in a process of its own: a
/// second opinion. Where there is no such program, the solution says so.
/// @param time_limit  [s]
LmiSolution solve_with_sdpa(const LmiProgram& program, double time_limit = 10.0,
                            const SolverOptions& options = {});

/// The program in the SDPA sparse format, which most solvers of semidefinite programs read:
/// minimize the first line of numbers times x such that Σ x_k F_k − F_0 is positive semidefinite,
/// block by block. Comments at its head say which block is which condition.
std::string sdpa_problem(const LmiProgram& program, const SolverOptions& options = {});

/// Solves with CSDP in a worker process of its own.
/// @param time_limit  [s]
LmiSolution solve_lmi(const LmiProgram& program, double time_limit = 10.0,
                      const SolverOptions& options = {});

}  // namespace sampled_data_observers
