#pragma once

#include <optional>

#include "certificate/certificate.h"
#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {

/// T2 of a section that says which times between events there are [s]: a number from `least` to
/// 1e6, or `.inf` for no longest time, ∞.
/// @throws ConfigError for anything else
double read_longest_time(ConfigSection& section, double least);

/// A section {tau, N0}.
/// @throws ConfigError for values that are none
DwellTime read_dwell_time(ConfigSection section, DwellTime::Kind kind);

/// The section average_dwell_time or reverse_average_dwell_time; none where neither is there.
/// @throws ConfigError for both, and for values that are none
std::optional<DwellTime> read_dwell_time(ConfigSection& section);

/// T1 and T2, or a dwell time, or a section `sensors` with T1 and T2 of each of several, of a
/// section that says which times between events there are.
/// @pre subject.plant is known
/// @throws ConfigError where T1 > T2, and for both
void read_event_times(ConfigSection& section, CertificateSubject& subject);

/// The section `timer_nodes`, where there is one: a list for each sampled sensor, or one for
/// `jumps`, of increasing times from 0 to the longest of that timer, its shortest among them [s].
/// @pre the times of the subject are known
/// @throws ConfigError for lists that are none such
void read_timer_nodes(ConfigSection& section, const Theorem& theorem, CertificateSubject& subject);

}  // namespace sampled_data_observers
