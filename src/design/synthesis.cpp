#include "design/synthesis.h"

#include "certificate/timer_dependent.h"
#include "design/analysis.h"
#include "design/rate_search.h"
#include "design/timer_cells.h"

namespace sampled_data_observers {
namespace {

bool depends_on_timers(const DesignMethod& method, const CertificateSubject& subject) {
  return method.theorem().sums_over_timers() ||
         timer_dependent_function(method.theorem(), subject).has_value();
}

Design synthesize_on_grid(const DesignMethod& method, const DesignProblem& problem,
                          const SynthesisOptions& options, const Design* coarser) {
  const bool seeks_rate = problem.objective == Objective::kMinFinalError &&
                          problem.given.count(searched_parameter(method, problem.subject)) == 0;
  Design design = coarser != nullptr && seeks_rate
                      ? search_rate_near(*coarser, method, problem, options)
                      : search_design(method, problem, options);
  if (problem.objective != Objective::kMinFinalError) return prove_further(design, options);
  // Where P depends on timers, it was found for the final error of these gains already.
  if (depends_on_timers(method, problem.subject)) return design;
  return prove_final_error(design, problem.assumptions, options);
}

}  // namespace

Design synthesize(const DesignMethod& method, const DesignProblem& problem,
                  const SynthesisOptions& options) {
  require_sense(method, problem);
  const bool has_rate = problem.given.count(method.decay_parameter()) > 0;
  Design design = solve_on_refined_cells(
      method.theorem(), problem.subject, problem.objective, problem.assumptions, has_rate,
      [&](const CertificateSubject& subject, const Design* coarser) {
        DesignProblem on_grid = problem;
        on_grid.subject = subject;
        return synthesize_on_grid(method, on_grid, options, coarser);
      });
  const bool is_of_norm = problem.objective == Objective::kMinFinalError && !has_rate &&
                          problem.subject.error_weights.size() == 0;
  if (!is_of_norm || !depends_on_timers(method, problem.subject)) return design;
  // The gains are good for the errors that the design weighs; what is published is a bound on the
  // norm.
  return prove_final_error_near(design, problem.assumptions, options);
}

}  // namespace sampled_data_observers
