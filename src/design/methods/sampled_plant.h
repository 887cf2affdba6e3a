#pragma once

#include <string>

#include "certificate/certificate.h"

namespace sampled_data_observers {

// What methods for sampled linear plants have in common.

/// That samples of some time in [T1, T2] apart don't show a mode that does not decay; empty where
/// there is none such, and for plants of which A alone does not tell (see require_detectable()).
std::string undetectable_sampling(const CertificateSubject& subject);

/// Solutions that are less far inside, by ConditionCheck::margin(), are on the edge: P is nearly
/// singular in any units, and what they prove is convergence that nobody would see.
constexpr double kLeastMargin = 1e-7;
std::string on_the_edge(double margin);

}  // namespace sampled_data_observers
