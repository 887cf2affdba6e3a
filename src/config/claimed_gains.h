#pragma once

#include <optional>

#include "certificate/certificate.h"
#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {

/// What a person can do about gains that a claim does not hold for.
extern const char kGainsRemedy[];

/// The gains that a theorem names, as the law computes with them.
/// @param gains  the section that the law was read from
/// @throws ConfigError for one that the law does not have, or that is a formula of it.
NamedMatrices gains_of_theorem(const ConfigSection& gains, const Theorem& theorem,
                               const CertificateSubject& subject, const LawGains& law);

/// Why a theorem is not about a law although it has all gains that the theorem names, if so: it
/// computes with others that are not zero, or takes states from outputs.
std::optional<ConfigError> objection_to_gains(const ConfigSection& gains, const Theorem& theorem,
                                              const CertificateSubject& subject,
                                              const LawGains& law);

}  // namespace sampled_data_observers
