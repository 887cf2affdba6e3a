#pragma once

#include <optional>

#include "design/design_method.h"

namespace sampled_data_observers {

/// From constant gains for which the conditions of a theorem that depends on timers hold at some
/// rate, perhaps a negative one, gains for which they hold at `rate` [1/s]: P and the gains are
/// improved in turn, each for the largest rate. Nothing where that ends too early.
/// @param subject  without disturbance
std::optional<NamedMatrices> gains_of_rate(const Theorem& theorem,
                                           const CertificateSubject& subject, NamedMatrices gains,
                                           double rate);

}  // namespace sampled_data_observers
