#include "design/analysis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "certificate/timer_dependent.h"
#include "design/certify.h"
#include "design/final_error.h"
#include "design/plant_scaling.h"
#include "design/rate_search.h"
#include "design/request_error.h"
#include "design/run_time_figures.h"
#include "design/timer_cells.h"

namespace sampled_data_observers {
namespace {

bool has_gamma(const Theorem& theorem, const CertificateSubject& subject) {
  const auto parameters = theorem.parameters(subject);
  return std::any_of(parameters.begin(), parameters.end(),
                     [](const NamedShape& shape) { return shape.name == "gamma"; });
}

/// Whether a design for this theorem could ask for its least gamma: that of an L2 gain to a
/// performance output says nothing without one.
bool gain_has_meaning(const Theorem& theorem, const CertificateSubject& subject) {
  bool has_design = false;
  for (const DesignMethod* method : design_methods()) {
    if (&method->theorem() != &theorem) continue;
    has_design = true;
    const auto all = method->objectives(subject);
    if (std::find(all.begin(), all.end(), Objective::kMinGamma) != all.end()) return true;
  }
  return !has_design;
}

/// What the first design method of a theorem does with a parameter: its default, or the range in
/// which it is searched for. Nothing where no method has it.
DesignParameter as_in_design(const Theorem& theorem, const CertificateSubject& subject,
                             const std::string& name) {
  for (const DesignMethod* method : design_methods()) {
    if (&method->theorem() != &theorem) continue;
    for (const DesignParameter& parameter : method->parameters(subject)) {
      if (parameter.name == name) return parameter;
    }
  }
  DesignParameter none;
  none.name = name;
  return none;
}

/// The design method whose gains are known.
class GivenGains : public DesignMethod {
 public:
  GivenGains(const Theorem& theorem, NamedMatrices gains)
      : theorem_(theorem), gains_(std::move(gains)) {}

  std::string name() const override { return "analysis"; }
  std::string summary() const override { return "proves given gains"; }
  const Theorem& theorem() const override { return theorem_; }

  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    const std::vector<NamedRange> ranges = theorem_.search_ranges(subject);
    std::vector<DesignParameter> all;
    for (const NamedShape& shape : theorem_.parameters(subject)) {
      DesignParameter parameter = as_in_design(theorem_, subject, shape.name);
      for (const NamedRange& named : ranges) {
        if (named.name == shape.name) parameter.search = named.range;
      }
      all.push_back(std::move(parameter));
    }
    return all;
  }

  std::vector<Objective> objectives(const CertificateSubject& subject) const override {
    std::vector<Objective> all = {Objective::kFeasible};
    if (std::isfinite(subject.T2)) all.push_back(Objective::kMaxT2);
    if (theorem_.sums_over_timers() || timer_dependent_function(theorem_, subject)) {
      all.push_back(Objective::kMinT1);
    }
    if (has_gamma(theorem_, subject) && gain_has_meaning(theorem_, subject))
      all.insert(all.begin(), Objective::kMinGamma);
    if (!theorem_.decay_parameter().empty()) all.push_back(Objective::kMaxDecay);
    if (has_final_error_level(theorem_, subject)) all.push_back(Objective::kMinFinalError);
    return all;
  }

  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override {
    return attempt_scaled(subject, parameters, objective, units_of_file(subject));
  }

  DesignCandidate attempt_scaled(const CertificateSubject& subject, const Parameters& parameters,
                                 Objective objective, const PlantScaling& scaling) const override {
    NamedMatrices fixed = scaled(theorem_, gains_, scaling);
    for (const NamedShape& shape : theorem_.parameters(subject)) {
      const auto given = parameters.find(shape.name);
      if (given != parameters.end()) fixed[shape.name] = scalar_matrix(given->second);
    }
    if (objective != Objective::kMinFinalError) {
      return certify_here(theorem_, subject, fixed, objective);
    }
    // The bound at run time is one of the norm in the units of the plant file.
    const ErrorAssumptions assumptions = final_error_assumptions(parameters);
    DesignCandidate found = certify_final_error(
        theorem_, subject, fixed,
        subject.error_weights.size() > 0 ? subject.error_weights : scaling.state, assumptions);
    if (!found.is_verified()) return found;
    const PlantScaling file = inverse_of(scaling);
    const ErrorAssumptions in_file = final_error_assumptions(scaled(
        theorem_, Parameters{{kNoise, assumptions.noise}, {kDisturbance, assumptions.disturbance}},
        file));
    found.cost = final_error(theorem_, scaled(subject, file),
                             unscaled(theorem_, found.values, scaling), in_file);
    return found;
  }

  void restore(const CertificateSubject&, NamedMatrices& values) const override {
    for (const auto& [name, value] : gains_) values[name] = value;
  }

 private:
  const Theorem& theorem_;
  NamedMatrices gains_;
};

AnalysisProblem final_error_problem(const Certificate& certificate,
                                    const ErrorAssumptions& assumptions) {
  AnalysisProblem problem;
  problem.theorem = certificate.theorem;
  problem.subject = certificate.subject;
  problem.objective = Objective::kMinFinalError;
  problem.assumptions = assumptions;
  for (const NamedShape& shape : certificate.theorem->gains(problem.subject)) {
    problem.gains[shape.name] = certificate.values.at(shape.name);
  }
  return problem;
}

/// Whether the analysis found as much as the design had, or more.
bool is_as_good(const Design& analysis, const Design& design, const std::string& decay) {
  const auto value = [](const Design& of, const std::string& name) {
    return scalar_value(of.certificate.values, name);
  };
  switch (design.objective) {
    case Objective::kMinGamma:
      return value(analysis, "gamma") <= value(design, "gamma");
    case Objective::kMaxT2:
      return analysis.certificate.subject.T2 >= design.certificate.subject.T2;
    case Objective::kMinT1:
      return analysis.certificate.subject.T1 <= design.certificate.subject.T1;
    case Objective::kMaxDecay:
      return value(analysis, decay) >= value(design, decay);
    case Objective::kFeasible:
    case Objective::kMinFinalError:
      break;
  }
  return false;
}

Design analyze_on_grid(const AnalysisProblem& problem, const SynthesisOptions& options) {
  const Theorem& theorem = *problem.theorem;
  const GivenGains method(theorem, problem.gains);
  for (const DesignParameter& parameter : method.parameters(problem.subject)) {
    const bool is_found = parameter.search || parameter.default_value ||
                          parameter.name == "gamma" ||
                          ((problem.objective == Objective::kMaxDecay ||
                            problem.objective == Objective::kMinFinalError) &&
                           parameter.name == theorem.decay_parameter());
    if (is_found || problem.given.count(parameter.name) > 0) continue;
    throw DesignError(theorem.name() + " needs a value of " + parameter.name + ": give --set " +
                      parameter.name + "=NUMBER");
  }
  DesignProblem search;
  search.subject = problem.subject;
  search.given = problem.given;
  search.objective = problem.objective;
  search.accepts_less = true;
  search.accepts_slow = problem.accepts_slow;
  search.assumptions = problem.assumptions;
  Design found = search_design(method, search, options);
  const bool has_any_gamma =
      problem.objective != Objective::kMinGamma && problem.objective != Objective::kMinFinalError &&
      has_gamma(theorem, problem.subject) && problem.given.count("gamma") == 0;
  if (!has_any_gamma) return found;
  search.subject = found.certificate.subject;
  search.objective = Objective::kMinGamma;
  const std::string decay = theorem.decay_parameter();
  if (!decay.empty()) search.given[decay] = scalar_value(found.certificate.values, decay);
  try {
    const Design least = search_design(method, search, options);
    found.certificate = least.certificate;
    found.margin = least.margin;
    found.proved_conditions = least.proved_conditions;
    found.attempts += least.attempts;
    found.seconds += least.seconds;
  } catch (const DesignError&) {
    // At the edge the proof at hand may be the only one.
  }
  return found;
}

/// The design, with another proof of its gains where that gives a smaller final error.
/// @param prove  of a problem
template <class Prove>
Design with_less_final_error(const Design& design, const ErrorAssumptions& assumptions,
                             Prove prove) {
  const Theorem& theorem = *design.certificate.theorem;
  if (!has_final_error_level(theorem, design.certificate.subject)) return design;
  const auto figure = [&](const Design& of) {
    return final_error(theorem, of.certificate.subject, of.certificate.values, assumptions);
  };
  Design best = design;
  try {
    const Design analysis = prove(final_error_problem(design.certificate, assumptions));
    best.attempts += analysis.attempts;
    best.seconds += analysis.seconds;
    if (figure(analysis) < figure(design)) {
      best.certificate = analysis.certificate;
      best.margin = analysis.margin;
      best.proved_conditions = analysis.proved_conditions;
      for (const NamedShape& shape : theorem.parameters(analysis.certificate.subject)) {
        best.parameters[shape.name] = scalar_value(analysis.certificate.values, shape.name);
      }
    }
  } catch (const DesignError&) {
    // The proof at hand is the best.
  }
  return best;
}

}  // namespace

std::vector<Objective> analysis_objectives(const Theorem& theorem,
                                           const CertificateSubject& subject) {
  std::vector<Objective> all = GivenGains(theorem, {}).objectives(subject);
  // The final error needs assumptions on noise and disturbance.
  all.erase(std::remove(all.begin(), all.end(), Objective::kMinFinalError), all.end());
  // A proof of a gain is one.
  if (all.front() == Objective::kMinGamma) {
    all.erase(std::find(all.begin(), all.end(), Objective::kFeasible));
  }
  return all;
}

Design analyze(const AnalysisProblem& problem, const SynthesisOptions& options) {
  const Theorem& theorem = *problem.theorem;
  try {
    require_subject(theorem, problem.subject);
  } catch (const std::invalid_argument& fault) {
    throw RequestError(theorem.name() + " is not for this plant: " + fault.what());
  }
  const bool has_rate = problem.given.count(theorem.decay_parameter()) > 0;
  return solve_on_refined_cells(theorem, problem.subject, problem.objective, problem.assumptions,
                                has_rate, [&](const CertificateSubject& subject, const Design*) {
                                  AnalysisProblem on_grid = problem;
                                  on_grid.subject = subject;
                                  return analyze_on_grid(on_grid, options);
                                });
}

Design prove_final_error(const Design& design, const ErrorAssumptions& assumptions,
                         const SynthesisOptions& options) {
  return with_less_final_error(design, assumptions, [&](AnalysisProblem problem) {
    problem.accepts_slow = false;
    return analyze(problem, options);
  });
}

Design prove_final_error_near(const Design& design, const ErrorAssumptions& assumptions,
                              const SynthesisOptions& options) {
  return with_less_final_error(design, assumptions, [&](const AnalysisProblem& problem) {
    const GivenGains method(*problem.theorem, problem.gains);
    DesignProblem search;
    search.subject = problem.subject;
    search.objective = problem.objective;
    search.accepts_less = true;
    search.accepts_slow = false;
    search.assumptions = assumptions;
    return search_rate_near(design, method, search, options);
  });
}

std::shared_ptr<const Design> own_proof_for_run_time(const Design& design,
                                                     const ErrorAssumptions& assumptions,
                                                     const SynthesisOptions& options) {
  constexpr double kWorthwhile = 0.99;
  const Certificate& certificate = design.certificate;
  const Theorem& theorem = *certificate.theorem;
  if (!has_final_error_level(theorem, certificate.subject)) return nullptr;
  AnalysisProblem problem = final_error_problem(certificate, assumptions);
  PlantMatrices& plant = problem.subject.plant;
  plant.C_p.resize(0, plant.states());
  if (plant.N.cols() == 0 || !bounds_disturbances(theorem)) problem.assumptions.disturbance = 0.0;
  const auto figure = [&](const Certificate& of) {
    return has_bound_for(of, problem.assumptions)
               ? final_error(theorem, of.subject, of.values, problem.assumptions)
               : std::numeric_limits<double>::infinity();
  };
  std::shared_ptr<const Design> best;
  double least = kWorthwhile * figure(certificate);
  const auto improves = [&] {
    try {
      const Design found = analyze(problem, options);
      const double value = figure(found.certificate);
      if (!(value < least)) return false;
      best = std::make_shared<const Design>(found);
      least = value;
      return true;
    } catch (const DesignError&) {
      return false;  // there need not be another proof
    }
  };
  improves();
  const std::string decay = theorem.decay_parameter();
  if (decay.empty()) return best;
  // No rate of that search need be possible: the one of the proof at hand is.
  double& rate = problem.given[decay];
  rate = scalar_value(certificate.values, decay);
  improves();
  if (!best) return best;
  constexpr double kFinest = 1.05;
  for (double factor = 1.7; factor > kFinest; factor = std::sqrt(factor)) {
    const double from = scalar_value(best->certificate.values, decay);
    rate = from * factor;
    if (!improves()) {
      rate = from / factor;
      improves();
    }
  }
  return best;
}

Design prove_further(const Design& design, const SynthesisOptions& options) {
  const Certificate& certificate = design.certificate;
  AnalysisProblem problem;
  problem.theorem = certificate.theorem;
  problem.subject = certificate.subject;
  problem.objective = design.objective;
  const std::vector<Objective> known = analysis_objectives(*problem.theorem, problem.subject);
  const bool has_meaning = design.objective != Objective::kFeasible &&
                           std::find(known.begin(), known.end(), design.objective) != known.end();
  if (!has_meaning || design.search_ended) return design;
  for (const NamedShape& shape : problem.theorem->gains(problem.subject)) {
    problem.gains[shape.name] = certificate.values.at(shape.name);
  }
  const std::vector<NamedRange> ranges = problem.theorem->search_ranges(problem.subject);
  for (const NamedShape& shape : problem.theorem->parameters(problem.subject)) {
    const bool is_searched =
        std::any_of(ranges.begin(), ranges.end(),
                    [&](const NamedRange& range) { return range.name == shape.name; });
    if (is_searched || (shape.name == "gamma" && design.parameters.count("gamma") == 0)) continue;
    problem.given[shape.name] = scalar_value(certificate.values, shape.name);
  }
  Design best = design;
  try {
    const Design analysis = analyze(problem, options);
    best.attempts += analysis.attempts;
    best.seconds += analysis.seconds;
    if (is_as_good(analysis, design, problem.theorem->decay_parameter())) {
      best.certificate = analysis.certificate;
      best.margin = analysis.margin;
      best.proved_conditions = analysis.proved_conditions;
    }
  } catch (const DesignError&) {
    // The proof at hand is the best.
  }
  return best;
}

}  // namespace sampled_data_observers
