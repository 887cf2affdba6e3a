#include "certificate/timer_dependent_theorem.h"

#include <cmath>
#include <utility>

#include "certificate/timer_dependent.h"
#include "certificate/timer_grid.h"

namespace sampled_data_observers {

std::vector<double> shortest_times(const CertificateSubject& subject) {
  std::vector<double> all;
  for (const SamplingTimes& times : times_of_timers(subject)) all.push_back(times.T1);
  return all;
}

std::vector<double> longest_times(const CertificateSubject& subject) {
  std::vector<double> all;
  for (const SamplingTimes& times : times_of_timers(subject)) all.push_back(times.T2);
  return all;
}

std::vector<NamedShape> TimerDependentTheorem::multipliers(
    const CertificateSubject& subject) const {
  return function(subject).shapes();
}

std::vector<std::string> TimerDependentTheorem::unlimited_multipliers(
    const CertificateSubject& subject) const {
  std::vector<std::string> names;
  for (const NamedShape& shape : multipliers(subject)) {
    if (shape.name == "P_rest" || shape.name.rfind("nu/", 0) == 0) names.push_back(shape.name);
  }
  return names;
}

std::vector<NamedShape> TimerDependentTheorem::parameters(const CertificateSubject& subject) const {
  std::vector<NamedShape> all = {scalar_shape("lambda_t")};
  if (subject.falls_at_events) all.push_back(scalar_shape("mu"));
  if (subject.plant.N.cols() > 0) all.push_back(scalar_shape("gamma"));
  return all;
}

std::vector<Condition> TimerDependentTheorem::conditions(const CertificateSubject& subject) const {
  std::vector<Condition> all;
  bool has_grid = true;
  for (const SamplingTimes& times : times_of_timers(subject)) {
    has_grid &= 0.0 <= times.T1 && times.T1 <= times.T2 && times.T2 > 0.0;
    for (Condition& domain : domain_of_times(times.T1, times.T2)) all.push_back(std::move(domain));
  }
  if (!has_grid) return all;
  for (const NamedShape& parameter : parameters(subject)) all.push_back(positive(parameter.name));
  if (subject.falls_at_events) {
    all.push_back(
        {"mu < 1", MatrixExpression(1.0) - symbol("mu"), std::nullopt, Condition::Kind::kPositive});
  }
  if (!subject.plant.is_linear() && subject.plant.vertices.empty()) {
    all.push_back({"lipschitz_constant >= 0", *subject.plant.lipschitz_constant, std::nullopt,
                   Condition::Kind::kNonNegative});
  }
  for (Condition& condition : function(subject).conditions()) all.push_back(std::move(condition));
  return all;
}

TimerDependentFunction TimerDependentTheorem::function(const CertificateSubject& subject) const {
  return {error(subject), grid_of(subject), shortest_times(subject), std::nullopt,
          subject.falls_at_events};
}

std::vector<GuaranteedFigure> TimerDependentTheorem::guaranteed_figures(
    const CertificateSubject& subject, const NamedMatrices& values) const {
  if (!subject.falls_at_events) return {};
  // V falls by mu once in each T2, or more often.
  const double at_events = -std::log(scalar_value(values, "mu")) / (2.0 * subject.T2);
  return {{"rate of convergence by flow and events together [1/s]",
           scalar_value(values, "lambda_t") + at_events}};
}

std::optional<TimerDependentFunction> timer_dependent_function(const Theorem& theorem,
                                                               const CertificateSubject& subject) {
  const auto* own = dynamic_cast<const TimerDependentTheorem*>(&theorem);
  if (own == nullptr) return std::nullopt;
  return own->function(subject);
}

}  // namespace sampled_data_observers
