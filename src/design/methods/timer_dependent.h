#pragma once

#include <string>
#include <vector>

#include "certificate/timer_dependent_conditions.h"
#include "design/design_method.h"

namespace sampled_data_observers {

// What designs by a Lyapunov function that depends on timers share.

/// lambda_t, and gamma where there is a disturbance.
std::vector<DesignParameter> timer_dependent_parameters(const CertificateSubject& subject);
std::vector<Objective> timer_dependent_objectives(const CertificateSubject& subject);

/// The subject as an inequality is about: without disturbance and performance output where gamma is
/// neither asked for nor given.
CertificateSubject timer_dependent_subject(const CertificateSubject& subject,
                                           const Parameters& parameters, Objective objective);

/// Adds the variables and inequalities of a function, and the objective, to a program.
void require_function(LmiProgram& program, const TimerDependentFunction& function,
                      const CertificateSubject& subject, const Parameters& parameters,
                      Objective objective);

}  // namespace sampled_data_observers
