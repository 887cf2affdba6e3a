#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "design/design_method.h"

namespace sampled_data_observers {

struct SynthesisOptions {
  unsigned jobs = 1;
  /// For one attempt [s]; a longer one is lost.
  double time_limit = 20.0;
  /// Called now and then with what is being done, for a progress display.
  std::function<void(const std::string& what, std::size_t attempts)> on_progress;
};

/// A verified design, and how it was found.
struct Design {
  std::string method;
  std::string observer_type;
  Certificate certificate;
  Objective objective = Objective::kFeasible;
  /// |w| for which the final error was made small, where the plant has an N.
  std::optional<double> disturbance;
  /// All scalars with which it was made.
  Parameters parameters;
  double margin = 0.0;
  /// Conditions of the theorem, which ball arithmetic proved all.
  std::size_t proved_conditions = 0;
  std::string solver;
  double seconds = 0.0;
  std::size_t attempts = 0;
  /// Where T2 or the rate was to be as large as possible, or T1 as short: that it could be made
  /// 1024 times what the search began with, or that part of it, where the search ended.
  bool search_ended = false;
  /// The same gains with the proof that bounds their error at run time better than this one; null
  /// where there is none.
  std::shared_ptr<const Design> for_run_time;
};

/// @throws RequestError when the method is not about the plant or its times.
void require_sense(const DesignMethod& method, const DesignProblem& problem);

/// Finds gains by a method: chooses what the user left open, searches for the parameters with a
/// range, and for max-T2 and max-decay by bisection for the largest value (to 0.1 %; it begins with
/// the T2 or the rate of the problem, less than which is no answer, or with a rate of 0.1/T2, and
/// ends at 1024 times that), for min-T1 for the shortest in the same way, from T1 or without one
/// from T2; it is 0 where the theorem is about any times and finds a proof. What counts as found is
/// proved in ball arithmetic.
/// @throws RequestError when the method is not about the plant or the objective, or a parameter
/// means nothing to it or is not finite; DesignError when the plant can't be observed, or no
/// attempt led to gains that the theorem's own conditions accept; the message says what was tried
/// and what to change.
Design search_design(const DesignMethod& method, const DesignProblem& problem,
                     const SynthesisOptions& options);

}  // namespace sampled_data_observers
