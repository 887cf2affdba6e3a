#pragma once

#include <vector>

#include "design/design_method.h"
#include "design/threads.h"

namespace sampled_data_observers {

/// Of what norm a gain may be: gain_bound as it is, where the user gave it, or in the units of
/// scaling_of(), where it is a default and must not depend on units.
enum class GainBound { kGiven, kOfScaledPlant };

/// One attempt at a design in the units of scaling_of().
/// A candidate of which is_verified() holds has gains within their bound, and all conditions of its
/// theorem are proved in ball arithmetic; where one of them is not, the message says which. For the
/// least gamma, larger ones are tried before a candidate is given up.
DesignCandidate proved_attempt(const DesignMethod& method, const CertificateSubject& subject,
                               const Parameters& parameters, Objective objective,
                               GainBound gain_bound);

/// The best of the attempts for these choices of the parameters, in threads. Where the method
/// tells by one program what an attempt will cost, only those that promise most are made,
/// until one is verified, and the others are no designs, with a message that says so. One that is
/// lost says why in its message.
/// @return  a candidate for each choice
std::vector<DesignCandidate> proved_attempts(const DesignMethod& method,
                                             const CertificateSubject& subject,
                                             const std::vector<Parameters>& choices,
                                             Objective objective, GainBound gain_bound,
                                             const ThreadOptions& threads);

}  // namespace sampled_data_observers
