#pragma once

#include <array>
#include <optional>
#include <string>

#include "certificate/certificate.h"
#include "console/command_line.h"

namespace sampled_data_observers {

/// What the command line says of the times between events, in place of what files say.
struct EventTimeArguments {
  std::optional<double> T1;                                 // [s]
  std::string T2;                                           // [s], or inf; empty where not given
  std::optional<std::array<double, 2>> average_dwell_time;  // tau [s], N0
  std::optional<std::array<double, 2>> reverse_average_dwell_time;
  std::optional<unsigned> cells;  // of each timer
};

/// @param source  where they are taken from without these options, for the help
void add_event_times(CommandLine& command, const std::string& source,
                     EventTimeArguments& arguments);

/// --T1 and --T2 are for all sensors.
/// @throws RequestError where those have different times of their own
void require_common_times(const CertificateSubject& subject);

/// T1 and T2 of the subject for each sensor, where there are several.
void give_to_all_sensors(CertificateSubject& subject);

/// @throws RequestError for T1 > T2, for bounds on single times beside a dwell time, and where
/// sensors have different times
void take_event_times(const EventTimeArguments& arguments, CertificateSubject& subject);

}  // namespace sampled_data_observers
