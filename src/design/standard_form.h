#pragma once

#include <map>
#include <utility>
#include <vector>

#include "design/lmi_solver.h"

namespace sampled_data_observers {

/// min c'x so that F_0 + Σ x_k F_k >= 0, block by block: what solvers are given.
struct StandardForm {
  std::vector<AffineMatrix> blocks;
  std::vector<double> objective;
};

/// Without objective, the last variable is how far the solution is inside the strict blocks, of
/// which as much as possible is wanted, up to 1.
/// @param blocks  of the compiled program
StandardForm standard_form(const LmiProgram& program, const std::vector<LmiProgram::Block>& blocks,
                           const SolverOptions& options);

/// Entries of the upper triangle of a symmetric matrix.
using TriangleEntries = std::map<std::pair<int, int>, double>;

/// That of F_k for each variable, of one block.
std::vector<TriangleEntries> triangles_of(const AffineMatrix& block, std::size_t variables);

/// Puts what a solver found into a solution, unless it is not finite, with a judgement of the
/// program's own blocks.
void take_variables(const LmiProgram& program, const std::vector<LmiProgram::Block>& blocks,
                    const std::vector<double>& x, LmiSolution& solution);

}  // namespace sampled_data_observers
