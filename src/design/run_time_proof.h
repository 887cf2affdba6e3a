#pragma once

#include <memory>

#include "design/design_search.h"

namespace sampled_data_observers {

/// The gains of a design for another objective with the proof that gives the least bound on their
/// final error: by its own theorem (own_proof_for_run_time()), or by a function of the timers
/// (timer_dependent_…); null where that is not less than what the design's own proof gives by 1 %.
std::shared_ptr<const Design> prove_for_run_time(const Design& design,
                                                 const ErrorAssumptions& assumptions,
                                                 const SynthesisOptions& options);

}  // namespace sampled_data_observers
