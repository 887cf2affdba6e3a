#pragma once

#include <optional>
#include <vector>

#include "certificate/timer_dependent_conditions.h"
#include "certificate/timer_dependent_sum.h"

namespace sampled_data_observers {

/// The Lyapunov function, multi-affine on a grid of all timers, of a theorem whose name begins with
/// timer_dependent; nothing for others.
/// @pre the theorem is about the subject
std::optional<TimerDependentFunction> timer_dependent_function(const Theorem& theorem,
                                                               const CertificateSubject& subject);

/// The sum of a theorem whose name begins with timer_dependent_sum; nothing for others, likewise.
std::optional<TimerDependentSum> timer_dependent_sum(const Theorem& theorem,
                                                     const CertificateSubject& subject);

/// Those of timer_dependent_switched, one for each mode in the plant's order.
std::vector<TimerDependentFunction> functions_of_modes(const CertificateSubject& subject);

}  // namespace sampled_data_observers
