#include "design/standard_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {

StandardForm standard_form(const LmiProgram& program, const std::vector<LmiProgram::Block>& blocks,
                           const SolverOptions& options) {
  StandardForm form;
  const int variables = program.scalar_variables();
  const auto objective = program.compile_objective();
  // Without objective: maximize t, so that strict blocks are >= t I and t <= 1.
  const int t = objective ? -1 : variables;
  form.objective.assign(static_cast<std::size_t>(variables) + (objective ? 0U : 1U), 0.0);
  for (const LmiProgram::Block& block : blocks) {
    // No variable changes it, and it would only bound t.
    if (block.matrix.is_constant()) continue;
    AffineMatrix matrix = block.matrix;
    if (block.is_strict) {
      const auto size = static_cast<int>(matrix.constant.rows());
      for (int i = 0; i < size; ++i) {
        if (objective) {
          matrix.constant(i, i) -= options.margin;
        } else {
          matrix.terms.push_back({t, i, i, -1.0});
        }
      }
    }
    form.blocks.push_back(std::move(matrix));
  }
  if (objective) {
    for (const AffineMatrix::Term& term : objective->terms) {
      form.objective[static_cast<std::size_t>(term.variable)] += term.coefficient;
    }
  } else {
    form.objective.back() = -1.0;
    form.blocks.push_back({Eigen::MatrixXd::Ones(1, 1), {{t, 0, 0, -1.0}}});
  }
  return form;
}

std::vector<TriangleEntries> triangles_of(const AffineMatrix& block, std::size_t variables) {
  std::vector<TriangleEntries> entries(variables);
  for (const AffineMatrix::Term& term : block.terms) {
    const std::pair<int, int> at = std::minmax(term.row, term.col);
    // Off the diagonal, both triangles are averaged.
    const double part = term.row == term.col ? 1.0 : 0.5;
    entries[static_cast<std::size_t>(term.variable)][at] += part * term.coefficient;
  }
  return entries;
}

void take_variables(const LmiProgram& program, const std::vector<LmiProgram::Block>& blocks,
                    const std::vector<double>& x, LmiSolution& solution) {
  if (!std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); })) return;
  solution.values = program.unpack(x);
  solution.margin = std::numeric_limits<double>::infinity();
  for (const LmiProgram::Block& block : blocks) {
    const double least = min_eigenvalue(evaluate(block.matrix, x));
    if (block.is_strict) solution.margin = std::min(solution.margin, least);
    // A bound is met up to rounding.
    const double tolerance = block.is_strict ? 0.0 : -1e-6;
    if (!(least > tolerance)) solution.violated.push_back({block.name, least});
  }
}

}  // namespace sampled_data_observers
