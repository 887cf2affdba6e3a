#pragma once

#include <string>

#include "sampled_data_observers/certificate/certificate.h"

namespace sampled_data_observers {

// For methods that need more of a plant than their theorem, whose conditions then can't hold.

/// @throws std::invalid_argument naming a mode that the sampled output never shows.
void require_detectable(const CertificateSubject& subject);

/// That samples of some time in [T1, T2] apart don't show a mode; empty where there is none such.
std::string undetectable_sampling(const CertificateSubject& subject);

}  // namespace sampled_data_observers
