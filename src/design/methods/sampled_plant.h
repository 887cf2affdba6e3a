#pragma once

#include <string>

#include "sampled_data_observers/certificate/certificate.h"

namespace sampled_data_observers {

/// That samples of some time in [T1, T2] apart don't show a mode; empty where there is none such.
std::string undetectable_sampling(const CertificateSubject& subject);

}  // namespace sampled_data_observers
