#include "design/synthesis.h"

#include "design/analysis.h"

namespace sampled_data_observers {

Design synthesize(const DesignMethod& method, const DesignProblem& problem,
                  const SynthesisOptions& options) {
  const Design design = search_design(method, problem, options);
  if (problem.objective == Objective::kMinFinalError) {
    return prove_final_error(design, problem.assumptions, options);
  }
  return prove_further(design, options);
}

}  // namespace sampled_data_observers
