#include "design/synthesis.h"

#include "design/analysis.h"
#include "design/timer_cells.h"

namespace sampled_data_observers {
namespace {

Design synthesize_on_grid(const DesignMethod& method, const DesignProblem& problem,
                          const SynthesisOptions& options) {
  const Design design = search_design(method, problem, options);
  if (problem.objective == Objective::kMinFinalError) {
    return prove_final_error(design, problem.assumptions, options);
  }
  return prove_further(design, options);
}

}  // namespace

Design synthesize(const DesignMethod& method, const DesignProblem& problem,
                  const SynthesisOptions& options) {
  require_sense(method, problem);
  return solve_on_refined_cells(method.theorem(), problem.subject, problem.objective,
                                problem.assumptions, [&](const CertificateSubject& subject) {
                                  DesignProblem on_grid = problem;
                                  on_grid.subject = subject;
                                  return synthesize_on_grid(method, on_grid, options);
                                });
}

}  // namespace sampled_data_observers
