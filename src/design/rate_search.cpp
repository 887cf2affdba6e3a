#include "design/rate_search.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "design/final_error.h"
#include "design/run_time_figures.h"

namespace sampled_data_observers {

std::string searched_parameter(const DesignMethod& method, const CertificateSubject& subject) {
  return subject.falls_at_events ? "mu" : method.decay_parameter();
}

Design search_rate_near(const Design& start, const DesignMethod& method, DesignProblem problem,
                        const SynthesisOptions& options) {
  constexpr double kStep = 1.5;
  const std::string searched = searched_parameter(method, problem.subject);
  const double first = scalar_value(start.certificate.values, searched);
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
  improves(first);
  for (const double step : {kStep, 1.0 / kStep}) {
    double value = faster(first, step);
    const double next = value;
    while (improves(value)) value = faster(value, step);
    if (value != next) break;
  }
  return *best;
}

}  // namespace sampled_data_observers
