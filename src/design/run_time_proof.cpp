#include "design/run_time_proof.h"

#include <limits>
#include <optional>
#include <string>

#include "certificate/timer_dependent.h"
#include "design/analysis.h"
#include "design/final_error.h"
#include "design/request_error.h"
#include "design/run_time_figures.h"
#include "design/run_time_norm.h"

namespace sampled_data_observers {
namespace {

constexpr double kWorthIt = 0.99;
/// Enough for most gains, and few enough for a search over rates.
constexpr int kCellsOfProof = 32;

double figure(const Certificate& certificate, const ErrorAssumptions& assumptions) {
  return has_bound_for(certificate, assumptions)
             ? final_error(*certificate.theorem, certificate.subject, certificate.values,
                           assumptions)
             : std::numeric_limits<double>::infinity();
}

/// The theorem of timers about the same gains of an observer; null where there is none.
const Theorem* counterpart(const Design& design) {
  const Certificate& certificate = design.certificate;
  if (timer_dependent_function(*certificate.theorem, certificate.subject) ||
      certificate.theorem->sums_over_timers()) {
    return nullptr;
  }
  for (const char* name : {"timer_dependent_constant_gain", "timer_dependent_intersample_injection",
                           "timer_dependent_sample_and_hold", "timer_dependent_synchronized"}) {
    const Theorem* theorem = find_theorem(name);
    if (theorem->observer_types().front() == design.observer_type) return theorem;
  }
  return nullptr;
}

/// What is to be analysed by that theorem; nothing where it is not about the plant.
std::optional<AnalysisProblem> problem_by_timers(const Design& design,
                                                 const ErrorAssumptions& assumptions) {
  AnalysisProblem problem;
  problem.theorem = counterpart(design);
  if (problem.theorem == nullptr) return std::nullopt;
  const Certificate& certificate = design.certificate;
  problem.subject = certificate.subject;
  PlantMatrices& plant = problem.subject.plant;
  plant.C_p.resize(0, plant.states());
  try {
    require_subject(*problem.theorem, problem.subject);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  problem.subject = with_cells(problem.subject, kCellsOfProof);
  problem.objective = Objective::kMinFinalError;
  problem.assumptions = assumptions;
  if (plant.N.cols() == 0 || !bounds_disturbances(*certificate.theorem)) {
    problem.assumptions.disturbance = 0.0;
  }
  for (const NamedShape& shape : problem.theorem->gains(problem.subject)) {
    const auto gain = certificate.values.find(shape.name);
    if (gain == certificate.values.end()) return std::nullopt;
    problem.gains.insert(*gain);
  }
  return problem;
}

}  // namespace

std::shared_ptr<const Design> prove_for_run_time(const Design& design,
                                                 const ErrorAssumptions& assumptions,
                                                 const SynthesisOptions& options) {
  std::shared_ptr<const Design> best = own_proof_for_run_time(design, assumptions, options);
  if (assumptions.disturbance == 0.0 || design.certificate.subject.plant.N.cols() == 0) {
    ErrorAssumptions undisturbed = assumptions;
    undisturbed.disturbance = 0.0;
    const std::shared_ptr<const Design> found = in_better_norm(design);
    const double least = figure(best ? best->certificate : design.certificate, undisturbed);
    if (found && figure(found->certificate, undisturbed) < kWorthIt * least) best = found;
  }
  const std::optional<AnalysisProblem> problem = problem_by_timers(design, assumptions);
  if (!problem) return best;
  const double least = figure(best ? best->certificate : design.certificate, problem->assumptions);
  try {
    const Design found = analyze(*problem, options);
    if (figure(found.certificate, problem->assumptions) < kWorthIt * least) {
      best = std::make_shared<const Design>(found);
    }
  } catch (const DesignError&) {
    // There need not be another proof.
  }
  return best;
}

}  // namespace sampled_data_observers
