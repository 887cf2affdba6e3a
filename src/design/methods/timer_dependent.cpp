#include "design/methods/timer_dependent.h"

#include <cmath>

#include "design/assumed_disturbance.h"
#include "design/final_error.h"
#include "design/methods/ferrante2019.h"

namespace sampled_data_observers {
namespace {

/// Of noise levels, in the units of the attempt: without one the program has no end.
constexpr double kLargestNoiseLevel = 1e6;

}  // namespace

std::vector<DesignParameter> timer_dependent_parameters(const CertificateSubject& subject) {
  std::vector<DesignParameter> all = {{"lambda_t",
                                       "rate of convergence [1/s]; 0.001/T2 where not given",
                                       1e-3 / subject.T2, std::nullopt}};
  if (subject.falls_at_events) {
    all.push_back(
        {"mu", "factor by which V falls at events", std::nullopt, final_error_falls(false)});
  }
  if (subject.plant.N.cols() > 0) {
    all.push_back({"gamma", "L2 gain from the disturbance, where it is not minimized", std::nullopt,
                   std::nullopt});
  }
  return all;
}

std::vector<Objective> timer_dependent_objectives(const CertificateSubject& subject) {
  std::vector<Objective> all = ferrante2019_objectives(subject);
  all.push_back(Objective::kMinT1);
  return all;
}

CertificateSubject timer_dependent_subject(const CertificateSubject& subject,
                                           const Parameters& parameters, Objective objective) {
  CertificateSubject own = subject;
  own.plant = ferrante2019_plant(subject, parameters, objective);
  return own;
}

void require_function(LmiProgram& program, const TimerDependentFunction& function,
                      const CertificateSubject& subject, const Parameters& parameters,
                      Objective objective) {
  const bool is_homogeneous = subject.plant.N.cols() == 0 && objective != Objective::kMinFinalError;
  for (const NamedShape& shape : function.shapes()) {
    if (shape.form != NamedShape::Form::kSymmetric) {
      const MatrixExpression value = program.scalar(shape.name);
      if (shape.name.rfind("nu/", 0) == 0) {
        program.bound_above(shape.name + " <= limit", value, kLargestNoiseLevel);
      }
      continue;
    }
    const MatrixExpression P = program.symmetric(shape.name, shape.rows);
    if (is_homogeneous) program.bound_above(shape.name + " <= I", P, identity(shape.rows));
  }
  program.fix("lambda_t", scalar_matrix(parameters.at("lambda_t")));
  if (function.falls_at_events()) program.fix("mu", scalar_matrix(parameters.at("mu")));
  add_gamma(program, subject, parameters, objective);
  for (const Condition& condition : function.conditions()) program.require(condition, 1);
  if (objective == Objective::kMinFinalError) {
    minimize_timer_dependent_level(program, function.system(), matrices_of(function), subject,
                                   weights_of_design(subject), parameters);
  }
}

}  // namespace sampled_data_observers
