#include "design/best_design.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "design/final_error.h"
#include "design/request_error.h"
#include "design/run_time_figures.h"
#include "design/synthesis.h"
#include "linear_algebra/tensor_grid.h"

namespace sampled_data_observers {
namespace {

/// Of a method that is tried: they find much the same gains, in several times its time. With a held
/// innovation, H = 0, the law is that of etienne2019.
constexpr const char* kVariants[] = {"ferrante2019_proposition3",
                                     "ferrante2019_proposition4",
                                     "ferrante2019_proposition5",
                                     "ferrante2019_alternating",
                                     "ferrante2019_proposition3_hold",
                                     "ferrante2019_proposition4_hold",
                                     "timer_dependent_alternating_injection",
                                     "timer_dependent_alternating_hold"};

bool applies(const DesignMethod& method, const DesignProblem& problem) {
  try {
    method.require_applicable(problem.subject);
    require_subject(method.theorem(), problem.subject);
  } catch (const std::invalid_argument&) {
    return false;
  }
  const auto objectives = method.objectives(problem.subject);
  if (std::find(objectives.begin(), objectives.end(), problem.objective) == objectives.end()) {
    return false;
  }
  return problem.objective != Objective::kMinFinalError || problem.assumptions.disturbance == 0.0 ||
         bounds_disturbances(method.theorem());
}

bool has_parameter(const DesignMethod& method, const CertificateSubject& subject,
                   const std::string& name) {
  const auto all = method.parameters(subject);
  return std::any_of(all.begin(), all.end(),
                     [&](const DesignParameter& parameter) { return parameter.name == name; });
}

/// Without the parameters that other methods have.
DesignProblem problem_for(const DesignMethod& method, const DesignProblem& problem) {
  DesignProblem own = problem;
  own.given.clear();
  own.searched.clear();
  for (const DesignParameter& parameter : method.parameters(problem.subject)) {
    const auto given = problem.given.find(parameter.name);
    if (given != problem.given.end()) own.given.insert(*given);
    if (problem.searched.count(parameter.name) > 0) own.searched.insert(parameter.name);
  }
  return own;
}

}  // namespace

std::vector<const DesignMethod*> methods_that_apply(const DesignProblem& problem) {
  std::vector<const DesignMethod*> all;
  for (const DesignMethod* method : design_methods()) {
    const bool is_variant = std::find(std::begin(kVariants), std::end(kVariants), method->name()) !=
                            std::end(kVariants);
    // For one sensor, gains that depend on its timer are hardly better than constant ones.
    const bool is_for_several = method->name() == "timer_dependent_scheduled_gain";
    if (is_variant || (is_for_several && problem.subject.plant.sampled.size() == 1)) continue;
    // On a grid, where there may be one, functions of timers prove more.
    if (method->theorem().sums_over_timers() &&
        problem.subject.plant.sampled.size() <= TensorGrid::kMaxDimensions) {
      continue;
    }
    if (applies(*method, problem)) all.push_back(method);
  }
  return all;
}

Parameters parameters_for(const DesignMethod* method, const CertificateSubject& subject,
                          const Parameters& given) {
  Parameters own;
  for (const auto& parameter : given) {
    const std::string& name = parameter.first;
    const auto& all = design_methods();
    if (std::none_of(all.begin(), all.end(),
                     [&](const DesignMethod* any) { return has_parameter(*any, subject, name); })) {
      throw RequestError("no method has a parameter '" + name + "'");
    }
    if (method == nullptr || has_parameter(*method, subject, name)) own.insert(parameter);
  }
  return own;
}

std::vector<MethodOutcome> synthesize_by_all(const std::vector<const DesignMethod*>& methods,
                                             const DesignProblem& problem,
                                             const SynthesisOptions& options) {
  std::vector<MethodOutcome> outcomes;
  for (const DesignMethod* method : methods) {
    MethodOutcome outcome;
    outcome.method = method->name();
    outcome.final_error = std::numeric_limits<double>::infinity();
    outcome.time_to_hundredth = std::numeric_limits<double>::infinity();
    try {
      outcome.design = synthesize(*method, problem_for(*method, problem), options);
      const Certificate& certificate = outcome.design->certificate;
      if (has_bound_for(certificate, problem.assumptions)) {
        const RunTimeFigures figures = run_time_figures(*certificate.theorem, certificate.subject,
                                                        certificate.values, problem.assumptions);
        outcome.final_error = final_error(*certificate.theorem, certificate.subject,
                                          certificate.values, problem.assumptions);
        outcome.time_to_hundredth = figures.time_to_hundredth;
      }
    } catch (const DesignError& error) {
      outcome.message = error.what();
    }
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

const MethodOutcome* best_of(const std::vector<MethodOutcome>& outcomes, Objective objective) {
  // What is compared first, and what decides between equals: the smaller, the better.
  const auto cost = [&](const MethodOutcome& outcome) {
    double own = 0.0;
    if (objective == Objective::kMaxT2) own = -outcome.design->certificate.subject.T2;
    if (objective == Objective::kMinT1) own = outcome.design->certificate.subject.T1;
    if (objective == Objective::kMaxDecay) own = outcome.time_to_hundredth;
    return std::make_tuple(std::isinf(outcome.final_error), own, outcome.final_error);
  };
  const MethodOutcome* best = nullptr;
  for (const MethodOutcome& outcome : outcomes) {
    if (!outcome.design) continue;
    if (best == nullptr || cost(outcome) < cost(*best)) best = &outcome;
  }
  return best;
}

}  // namespace sampled_data_observers
