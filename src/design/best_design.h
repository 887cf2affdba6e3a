#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/design_search.h"

namespace sampled_data_observers {

/// What came of one of several methods.
struct MethodOutcome {
  std::string method;
  std::optional<Design> design;
  /// Of its bound at run time, under the problem's assumptions; infinite where it has none.
  double final_error = 0.0;
  /// When its bound at run time has fallen to a hundredth of the initial error [s]; infinite where
  /// it has none.
  double time_to_hundredth = 0.0;
  /// Why there is no design.
  std::string message;
};

/// The methods that are about the problem's plant and times, serve its objective, and give a bound
/// under its assumptions. Of ferrante2019 only Proposition 2, with any H and as a predictor: the
/// others find much the same, in several times its time.
std::vector<const DesignMethod*> methods_that_apply(const DesignProblem& problem);

/// Of parameters that a plant file gives for several methods, those that this one has; all of them
/// where it is null.
/// @throws RequestError for one that no method has
Parameters parameters_for(const DesignMethod* method, const CertificateSubject& subject,
                          const Parameters& given);

/// Designs by each of these methods. Parameters that a method does not have are not given to it.
std::vector<MethodOutcome> synthesize_by_all(const std::vector<const DesignMethod*>& methods,
                                             const DesignProblem& problem,
                                             const SynthesisOptions& options);

/// The outcome whose design serves the objective best among those with a bound on the final error:
/// for max-T2 the longest T2, for max-decay the shortest time to a hundredth, else the least bound.
/// Null where there is no design.
const MethodOutcome* best_of(const std::vector<MethodOutcome>& outcomes, Objective objective);

}  // namespace sampled_data_observers
