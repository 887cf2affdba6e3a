#pragma once

#include "design/design_search.h"

namespace sampled_data_observers {

/// What is asked about given gains.
struct AnalysisProblem {
  const Theorem* theorem = nullptr;
  CertificateSubject subject;
  /// All gains that the theorem names.
  NamedMatrices gains;
  /// Parameters of the theorem that are fixed; the others are searched for.
  Parameters given;
  Objective objective = Objective::kFeasible;
  /// For min-final-error.
  ErrorAssumptions assumptions;
  /// Whether its proof may be about a rate at which the error hardly falls.
  bool accepts_slow = true;
};

/// The objectives that have a meaning for a theorem and a plant, of which the first is its main
/// one: min-gamma where the theorem has a gain, else feasible.
std::vector<Objective> analysis_objectives(const Theorem& theorem,
                                           const CertificateSubject& subject);

/// Proves given gains by a theorem, with its multipliers and parameters free: the least L2 gain, or
/// the largest T2 or rate of convergence for which the theorem's own conditions hold. Where the
/// theorem has a gain that is neither given nor asked for, the least one that goes with these.
/// @throws DesignError when the theorem is not about the plant, a parameter without range is not
/// given, or no proof is found.
Design analyze(const AnalysisProblem& problem, const SynthesisOptions& options);

/// The design with the proof that gives the least bound on the final error of its gains; the design
/// itself where the search finds no better one.
Design prove_final_error(const Design& design, const ErrorAssumptions& assumptions,
                         const SynthesisOptions& options);

/// The same for a Lyapunov function that depends on timers, of the same kind and on the same nodes:
/// searched for from the rate of the design on.
Design prove_final_error_near(const Design& design, const ErrorAssumptions& assumptions,
                              const SynthesisOptions& options);

/// The gains of a design with the proof by its own theorem that gives the least bound on their
/// final error, for its N (without one, for no disturbance) and no performance output; null where
/// that is not less than what the design's own proof gives by 1 %.
std::shared_ptr<const Design> own_proof_for_run_time(const Design& design,
                                                     const ErrorAssumptions& assumptions,
                                                     const SynthesisOptions& options);

/// The design, or one with the same gains that analysis finds to be better by the objective.
Design prove_further(const Design& design, const SynthesisOptions& options);

}  // namespace sampled_data_observers
