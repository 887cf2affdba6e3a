#include "design/synthesis.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "certificate/timer_dependent.h"
#include "design/analysis.h"
#include "design/final_error.h"
#include "design/run_time_figures.h"
#include "design/timer_cells.h"

namespace sampled_data_observers {
namespace {

bool depends_on_timers(const DesignMethod& method, const CertificateSubject& subject) {
  return timer_dependent_function(method.theorem(), subject).has_value();
}

/// What the final error is least for one value of: the rate, or the factor at events.
std::string searched_parameter(const DesignMethod& method, const CertificateSubject& subject) {
  return subject.falls_at_events ? "mu" : method.decay_parameter();
}

/// From the rate of a design on fewer cells up or down, as long as that makes the final error less.
Design climb(const DesignMethod& method, DesignProblem problem, const SynthesisOptions& options,
             const Design& coarser) {
  constexpr double kStep = 1.5;
  const std::string searched = searched_parameter(method, problem.subject);
  const double start = scalar_value(coarser.certificate.values, searched);
  // A factor is e to the minus rate.
  const auto faster = [&](double value, double factor) {
    return problem.subject.falls_at_events ? std::pow(value, factor) : value * factor;
  };
  std::optional<Design> best;
  double least = std::numeric_limits<double>::infinity();
  std::size_t attempts = 0;
  double seconds = 0.0;
  const auto improves = [&](double value) {
    problem.given[searched] = value;
    try {
      Design found = search_design(method, problem, options);
      attempts += found.attempts;
      seconds += found.seconds;
      found.attempts = attempts;
      found.seconds = seconds;
      const Certificate& certificate = found.certificate;
      const double value = final_error(*certificate.theorem, certificate.subject,
                                       certificate.values, problem.assumptions);
      if (!(value < least)) return false;
      least = value;
      best = std::move(found);
      return true;
    } catch (const DesignError&) {
      if (!best) throw;
      return false;
    }
  };
  improves(start);
  for (const double step : {kStep, 1.0 / kStep}) {
    double value = faster(start, step);
    const double first = value;
    while (improves(value)) value = faster(value, step);
    if (value != first) break;
  }
  return *best;
}

Design synthesize_on_grid(const DesignMethod& method, const DesignProblem& problem,
                          const SynthesisOptions& options, const Design* coarser) {
  const bool seeks_rate = problem.objective == Objective::kMinFinalError &&
                          problem.given.count(searched_parameter(method, problem.subject)) == 0;
  Design design = coarser != nullptr && seeks_rate ? climb(method, problem, options, *coarser)
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
  return prove_final_error(design, problem.assumptions, options);
}

}  // namespace sampled_data_observers
