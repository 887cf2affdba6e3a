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
};

/// @param source  where they are taken from without these options, for the help
void add_event_times(CommandLine& command, const std::string& source,
                     EventTimeArguments& arguments);

/// @throws RequestError for T1 > T2, and for bounds on single times beside a dwell time
void take_event_times(const EventTimeArguments& arguments, CertificateSubject& subject);

}  // namespace sampled_data_observers
