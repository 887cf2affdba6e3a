#pragma once

#include "sampled_data_observers/design/design_method.h"

namespace sampled_data_observers {

/// Proves given gains: looks for the theorem's multipliers with everything else fixed, where its
/// conditions are linear matrix inequalities, and checks the conditions themselves.
///
/// With Objective::kMinGamma the least gamma is found first, and then a proof as far inside as
/// possible for a gamma larger by 0.1 %. With others, gamma is a multiplier where `fixed` has none.
///
/// @param fixed  gains and parameters of the theorem; multipliers among them are left as they are
/// To be called in a worker process.
DesignCandidate certify_here(const Theorem& theorem, const CertificateSubject& subject,
                             const NamedMatrices& fixed, Objective objective);

}  // namespace sampled_data_observers
