#pragma once

#include <vector>

#include "certificate/certificate.h"
#include "design/rigorous_check.h"

namespace sampled_data_observers {

/// prove() for all conditions of a certificate. Where the states have units so unlike each other
/// that an enclosure in them would take too long, it looks for a proof in units that differ from
/// those by powers of two first: what is proved there, of all numbers that are rounded to those of
/// the certificate, is proved of the certificate. Nothing is disproved there.
/// @param options  the time is that of either
std::vector<ConditionProof> prove(const Certificate& certificate, const ProofOptions& options);

}  // namespace sampled_data_observers
