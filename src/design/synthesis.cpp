#include "design/synthesis.h"

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

/// From the rate of a design on fewer cells up or down, as long as that makes the final error less.
Design climb(const DesignMethod& method, DesignProblem problem, const SynthesisOptions& options,
             const Design& coarser) {
  constexpr double kStep = 1.5;
  const std::string decay = method.decay_parameter();
  const double start = scalar_value(coarser.certificate.values, decay);
  std::optional<Design> best;
  double least = std::numeric_limits<double>::infinity();
  std::size_t attempts = 0;
  double seconds = 0.0;
  const auto improves = [&](double rate) {
    problem.given[decay] = rate;
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
  double rate = start * kStep;
  for (; improves(rate); rate *= kStep) {
  }
  if (rate > start * kStep) return *best;
  for (rate = start / kStep; improves(rate); rate /= kStep) {
  }
  return *best;
}

Design synthesize_on_grid(const DesignMethod& method, const DesignProblem& problem,
                          const SynthesisOptions& options, const Design* coarser) {
  const bool seeks_rate = problem.objective == Objective::kMinFinalError &&
                          problem.given.count(method.decay_parameter()) == 0;
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
  return solve_on_refined_cells(method.theorem(), problem.subject, problem.objective,
                                problem.assumptions,
                                [&](const CertificateSubject& subject, const Design* coarser) {
                                  DesignProblem on_grid = problem;
                                  on_grid.subject = subject;
                                  return synthesize_on_grid(method, on_grid, options, coarser);
                                });
}

}  // namespace sampled_data_observers
