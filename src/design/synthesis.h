#pragma once

#include "design/design_search.h"

namespace sampled_data_observers {

/// Finds gains by a method (search_design()). Then, with the gains fixed, looks for a proof that
/// reaches further than the one that led to them, as Remark 9 of ferrante2019 proposes.
/// @throws RequestError, DesignError  as search_design()
Design synthesize(const DesignMethod& method, const DesignProblem& problem,
                  const SynthesisOptions& options);

}  // namespace sampled_data_observers
