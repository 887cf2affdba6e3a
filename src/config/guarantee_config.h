#pragma once

#include <memory>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "certificate/error_bound.h"
#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/config/observer_config.h"

namespace sampled_data_observers {

/// What a configuration guarantees of its estimates. doc/certificates.md describes it.
struct Guarantee {
  /// Theorem and guarantee; empty where there is no certificate that holds.
  std::string text;
  /// Why a certificate that does not hold was accepted; else empty.
  std::string warning;
  /// That a certificate that holds is not known to be proved; else empty.
  std::string remark;
  /// Null where the configuration asks for none.
  std::unique_ptr<const ErrorBound> bound;
  /// How long after their stamps inputs and jumps may come [ns].
  Duration latency = 0;
  /// |η| <= this at every measurement.
  double noise = 0.0;
  /// Those that the text speaks of, which must be watched for it to be in force.
  std::vector<DwellTime> dwell_times;
};

/// Reads the sections `certificate` and `error_assumptions` and the key `allow_uncertified`, and
/// checks that the certificate is about this plant, observer and sampling, and that the theorem's
/// conditions hold for these gains, and that its steps of integration follow the flow.
/// @param tree    that `root` reads, for the plant's fingerprint
/// @param config  with type, plant, law (nothing around it) and options read
/// @throws ConfigError where it does not hold and that is not allowed, and for the first fault.
Guarantee read_guarantee(ConfigSection& root, const ConfigNode& tree, const ObserverConfig& config,
                         bool delays_jumps);

}  // namespace sampled_data_observers
