#pragma once

#include <string>

#include "certificate/certificate.h"

namespace sampled_data_observers {

/// For theorems about ẋ = A x + B u with one sensor y = C x, sampled T1 to T2 apart.
/// @throws std::invalid_argument beginning with the paper's key, for all else.
void require_linear_sampling(const std::string& paper, const CertificateSubject& subject);

/// @throws std::invalid_argument beginning with the paper's key, for a disturbance of the flow.
void require_no_disturbance(const std::string& paper, const ErrorAssumptions& assumptions);

}  // namespace sampled_data_observers
