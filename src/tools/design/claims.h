#pragma once

#include <string>
#include <vector>

#include "config/certificate_config.h"

namespace sampled_data_observers {

/// The claims of a gain file about its plant: that of `certificate`, and that of
/// `run_time_certificate` where there is one. Their conditions are not yet checked.
/// @throws ConfigError where files can't be read, have no certificate, or are about other plants,
/// gains or formulas.
std::vector<CertificateConfig> read_claims(const std::string& gain_file,
                                           const std::vector<std::string>& plant_files);

}  // namespace sampled_data_observers
