#include "design/attempts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <utility>

#include "design/certify.h"
#include "design/final_error.h"
#include "design/plant_scaling.h"
#include "design/rigorous_check.h"
#include "design/work_limit.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// By which a least gamma is enlarged where its own proof fails.
constexpr double kFurtherInflations[] = {1.003, 1.01, 1.03};
/// How many of several choices are tried at a time, those first that promise most.
constexpr std::size_t kPromising = 2;
/// Of the norm of a gain, for rounding.
constexpr double kBoundTolerance = 1e-9;

std::ostringstream number_text() {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  return text;
}

void refuse(DesignCandidate& candidate, const std::string& message) {
  candidate.values.clear();
  candidate.proved_conditions = 0;
  candidate.message = message;
}

/// Of the largest of the gains that are bounded; 0 where there are none.
double bounded_norm(const std::vector<std::string>& names, const NamedMatrices& values) {
  double largest = 0.0;
  for (const std::string& name : names) largest = std::max(largest, norm2(values.at(name)));
  return largest;
}

void require_gain_bound(double norm, double bound, DesignCandidate& candidate) {
  if (norm <= bound * (1.0 + kBoundTolerance)) return;
  std::ostringstream text = number_text();
  text.precision(4);
  text << "the solver left the bound on a gain: its norm is larger than gain_bound = " << bound;
  refuse(candidate, text.str());
}

void require_proof(const Theorem& theorem, const CertificateSubject& subject,
                   RoundedNumbers rounded, double unit_of_time, DesignCandidate& candidate) {
  ProofOptions options;
  options.rounded = rounded;
  const auto proofs = prove(theorem.conditions(subject), candidate.values, options);
  for (const ConditionProof& proof : proofs) {
    if (proof.status == ProofStatus::kProved) continue;
    std::ostringstream text = number_text();
    text << "not proved in ball arithmetic: " << proof.name;
    if (proof.status == ProofStatus::kDisproved) {
      text << " does not hold";
    } else {
      text << " is undecided";
    }
    if (proof.tau) text << " at tau = " << unit_of_time * *proof.tau << " s";
    refuse(candidate, text.str());
    return;
  }
  candidate.proved_conditions = proofs.size();
}

/// Where the final error is to be small, a gain for noise and disturbance is one for their sizes.
Parameters with_sizes(Parameters parameters, Objective objective) {
  if (objective != Objective::kMinFinalError) return parameters;
  for (const auto& [size, assumed] :
       {std::pair("noise_size", kNoise), std::pair("disturbance_size", kDisturbance)}) {
    const auto found = parameters.find(size);
    if (found != parameters.end()) found->second = parameters.at(assumed);
  }
  return parameters;
}

/// Of a bound on the norm of the state: the noise that it is for is the unit of states and outputs.
void measure_by_noise(const Parameters& parameters, PlantScaling& scaling) {
  const auto noise = parameters.find("noise_size");
  if (noise == parameters.end() || !(noise->second > 0.0)) return;
  const double factor = noise->second / scaling.output(0);
  scaling.state *= factor;
  scaling.output *= factor;
  scaling.disturbance *= factor;
  scaling.performance *= factor;
}

/// The units in which a method is best served, without changing what is asked of it.
PlantScaling units_for(const DesignMethod& method, const CertificateSubject& subject,
                       const Parameters& parameters, Objective objective, bool keeps_gains) {
  const Theorem& theorem = method.theorem();
  KeptNorms kept;
  kept.of_state =
      keeps_gains || (has_norm_of_state(theorem) &&
                      (objective == Objective::kMinGamma || parameters.count("gamma") > 0));
  // Noise is as large as the norm of what it adds to all outputs.
  kept.of_outputs =
      keeps_gains || has_norm_of_state(theorem) || objective == Objective::kMinFinalError;
  kept.of_each_sensor = has_norm_of_noise(theorem);
  PlantScaling scaling = scaling_of(theorem, subject, kept);
  if (has_norm_of_state(theorem)) measure_by_noise(parameters, scaling);
  return scaling;
}

/// What is found for a plant in other units.
struct ScaledAttempt {
  const DesignMethod& method;
  const CertificateSubject& subject;
  const Parameters& parameters;
  Objective objective;
  PlantScaling scaling;

  const Theorem& theorem() const { return method.theorem(); }

  /// The candidate in the units of the plant file. It is checked and proved in such as differ from
  /// them by powers of two: what holds in those holds for the same numbers in these, and for all
  /// that are rounded to them.
  DesignCandidate proved(const DesignCandidate& found) const {
    const NamedMatrices values = in_units_of_file(found.values);
    const bool is_in_file = has_conditions_for_units(theorem());
    const PlantScaling exact =
        is_in_file ? units_of_file(subject) : rounded_to_powers_of_two(scaling);
    const CertificateSubject exactly = scaled(subject, exact);
    DesignCandidate candidate =
        judged(theorem(), exactly, scaled(theorem(), values, exact), objective, found);
    if (candidate.is_verified()) {
      require_proof(theorem(), exactly,
                    is_in_file ? RoundedNumbers::kNotWhole : RoundedNumbers::kAllButZero,
                    exact.time, candidate);
    }
    if (candidate.is_verified()) candidate.values = values;
    // The units of the attempt are the same whatever those of the file.
    candidate.cost =
        objective == Objective::kMinGamma ? theorem().gain_figure(values).value : found.cost;
    return candidate;
  }

  /// With the same gains and parameters, a gamma that is not quite the least.
  DesignCandidate with_larger_gamma(const DesignCandidate& found, double factor) const {
    NamedMatrices fixed = found.values;
    for (const NamedShape& shape : theorem().multipliers(subject)) fixed.erase(shape.name);
    fixed["gamma"] = scalar_matrix(factor * scalar_value(found.values, "gamma"));
    DesignCandidate next =
        certify_here(theorem(), scaled(subject, scaling), fixed, Objective::kFeasible);
    next.solver = found.solver;
    return next;
  }

 private:
  /// What was given, and what gains are by definition, is so to the bit.
  NamedMatrices in_units_of_file(const NamedMatrices& found) const {
    NamedMatrices values = unscaled(theorem(), found, scaling);
    for (const NamedShape& shape : theorem().parameters(subject)) {
      const auto given = parameters.find(shape.name);
      const bool is_minimized = shape.name == "gamma" && objective == Objective::kMinGamma;
      if (given == parameters.end() || is_minimized) continue;
      values[shape.name] = scalar_matrix(given->second);
    }
    method.restore(subject, values);
    return values;
  }
};

/// The plant, the parameters and their units in which an attempt is made.
struct AttemptInUnits {
  AttemptInUnits(const DesignMethod& method, const CertificateSubject& subject,
                 const Parameters& given, Objective objective, GainBound gain_bound)
      : parameters(with_sizes(given, objective)),
        bounded(method.bounded_gains(subject)),
        keeps_norms(gain_bound == GainBound::kGiven && !bounded.empty()),
        scaling(units_for(method, subject, parameters, objective, keeps_norms)),
        in_units(scaled(method.theorem(), parameters, scaling)),
        subject_in_units(scaled(subject, scaling)) {
    if (keeps_norms) in_units["gain_bound"] /= gain_unit(bounded.front(), scaling);
  }

  Parameters parameters;
  std::vector<std::string> bounded;
  bool keeps_norms;
  PlantScaling scaling;
  Parameters in_units;
  CertificateSubject subject_in_units;
};

/// @param candidate  of which the outcome is
void say_how_it_ended(const ThreadOutcome& outcome, DesignCandidate& candidate) {
  if (outcome.status == ThreadOutcome::Status::kDone) return;
  candidate = DesignCandidate();
  candidate.message =
      outcome.status == ThreadOutcome::Status::kTimedOut ? OutOfTime().what() : outcome.message;
}

/// What an attempt for each choice will cost: 0 where the method can't tell, infinite where there
/// is no solution, as the message of its candidate says.
std::vector<double> estimated_costs(const DesignMethod& method, const CertificateSubject& subject,
                                    const std::vector<Parameters>& choices, Objective objective,
                                    GainBound gain_bound, const ThreadOptions& threads,
                                    std::vector<DesignCandidate>& candidates) {
  std::vector<double> costs(choices.size(), std::numeric_limits<double>::infinity());
  const auto outcomes = run_in_threads(
      choices.size(),
      [&](std::size_t i) {
        const AttemptInUnits units(method, subject, choices[i], objective, gain_bound);
        const auto estimate = method.estimate(units.subject_in_units, units.in_units, objective);
        costs[i] = estimate ? estimate->cost : 0.0;
        if (estimate) candidates[i].message = estimate->message;
      },
      threads);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    say_how_it_ended(outcomes[i], candidates[i]);
    if (outcomes[i].status != ThreadOutcome::Status::kDone) {
      costs[i] = std::numeric_limits<double>::infinity();
    }
  }
  return costs;
}

}  // namespace

DesignCandidate proved_attempt(const DesignMethod& method, const CertificateSubject& subject,
                               const Parameters& given, Objective objective, GainBound gain_bound) {
  const AttemptInUnits units(method, subject, given, objective, gain_bound);
  const std::vector<std::string>& bounded = units.bounded;
  const ScaledAttempt attempt{method, subject, units.parameters, objective, units.scaling};
  DesignCandidate first =
      method.attempt_scaled(units.subject_in_units, units.in_units, objective, units.scaling);
  if (!first.is_verified()) return first;
  const double norm = bounded_norm(bounded, first.values);
  if (!bounded.empty()) require_gain_bound(norm, units.in_units.at("gain_bound"), first);
  if (!first.is_verified()) return first;
  DesignCandidate candidate = attempt.proved(first);
  for (const double factor : kFurtherInflations) {
    if (candidate.is_verified() || objective != Objective::kMinGamma) break;
    const DesignCandidate next = attempt.with_larger_gamma(first, factor);
    if (next.is_verified()) candidate = attempt.proved(next);
  }
  if (candidate.is_verified() && !bounded.empty()) {
    const double factor = bounded_norm(bounded, candidate.values) / norm;
    candidate.gain_bound = units.keeps_norms ? units.parameters.at("gain_bound")
                                             : units.in_units.at("gain_bound") * factor;
    if (units.keeps_norms) {
      require_gain_bound(bounded_norm(bounded, candidate.values), candidate.gain_bound, candidate);
    }
  }
  return candidate;
}

std::vector<DesignCandidate> proved_attempts(const DesignMethod& method,
                                             const CertificateSubject& subject,
                                             const std::vector<Parameters>& choices,
                                             Objective objective, GainBound gain_bound,
                                             const ThreadOptions& threads) {
  std::vector<DesignCandidate> candidates(choices.size());
  const auto try_all = [&](const std::vector<std::size_t>& numbers) {
    ThreadOptions options = threads;
    if (choices.size() > 1) options.on_done = nullptr;  // each was told of already
    const auto outcomes = run_in_threads(
        numbers.size(),
        [&](std::size_t i) {
          candidates[numbers[i]] =
              proved_attempt(method, subject, choices[numbers[i]], objective, gain_bound);
        },
        options);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      say_how_it_ended(outcomes[i], candidates[numbers[i]]);
    }
  };
  std::vector<double> costs(choices.size(), 0.0);
  if (choices.size() > 1) {
    costs = estimated_costs(method, subject, choices, objective, gain_bound, threads, candidates);
  }
  std::vector<std::size_t> waiting;
  for (std::size_t i = 0; i < choices.size(); ++i) waiting.push_back(i);
  std::stable_sort(waiting.begin(), waiting.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  bool is_found = false;
  for (std::size_t done = 0; done < waiting.size();) {
    if (std::isinf(costs[waiting[done]])) break;
    // Estimates that are equal, as where there are none, are tried together.
    std::vector<std::size_t> next;
    const double least = costs[waiting[done]];
    while (done < waiting.size() && !std::isinf(costs[waiting[done]]) &&
           (next.size() < kPromising || costs[waiting[done]] == least)) {
      next.push_back(waiting[done++]);
    }
    if (is_found) {
      for (const std::size_t i : next) candidates[i].message = "promised less than others";
      continue;
    }
    try_all(next);
    for (const std::size_t i : next) is_found = is_found || candidates[i].is_verified();
  }
  return candidates;
}

}  // namespace sampled_data_observers
