#pragma once

#include "design/design_method.h"

namespace sampled_data_observers {

/// Constant gains L to begin with, of any number of sensors, by a sum of functions of one timer
/// each: those of K_i(τ) = P⁺(τ)⁻¹ Y_i with constant Y_i, for which one convex program finds P and
/// Y, at the mean of P over the other timers. Empty where the program has no solution.
NamedMatrices gains_for_constant_products(const CertificateSubject& subject,
                                          const Parameters& parameters, Objective objective);

}  // namespace sampled_data_observers
