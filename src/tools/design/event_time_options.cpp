#include "tools/design/event_time_options.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "certificate/timer_grid.h"
#include "config/size_limits.h"
#include "console/option_checks.h"
#include "design/request_error.h"

namespace sampled_data_observers {
namespace {

DwellTime dwell_time_of(DwellTime::Kind kind, const std::array<double, 2>& values) {
  const auto [tau, N0] = values;
  if (tau > 0.0 && N0 >= 1.0 && N0 == std::floor(N0)) return {kind, tau, N0};
  throw RequestError("a dwell time: expected TAU > 0 [s] and a whole number N0 >= 1");
}

/// With so many cells of each timer. What observers read of a grid is limited.
CertificateSubject with_readable_cells(const CertificateSubject& subject, unsigned cells) {
  std::size_t nodes = cells;
  if (nodes <= kMostTimerNodes) {
    CertificateSubject on_grid = with_cells(subject, static_cast<int>(cells));
    // The nodes of more timers make no grid.
    if (on_grid.timer_nodes.size() > TensorGrid::kMaxDimensions) return on_grid;
    nodes = 1;
    for (const std::vector<double>& of_timer : on_grid.timer_nodes) nodes *= of_timer.size();
    if (nodes <= kMostTimerNodes) return on_grid;
  }
  throw RequestError("--cells: expected at most " + std::to_string(kMostTimerNodes) +
                     " nodes of the grid, the product of those of its timers, found " +
                     std::to_string(nodes) + " or more");
}

}  // namespace

void require_common_times(const CertificateSubject& subject) {
  for (const SamplingTimes& times : subject.sensor_times) {
    if (times.T1 == subject.T1 && times.T2 == subject.T2) continue;
    throw RequestError(
        "--T1 and --T2 are the times of all sensors, but these have times of their own: change "
        "design/sampling, or sensors/NAME/sampling");
  }
}

void give_to_all_sensors(CertificateSubject& subject) {
  const std::size_t sensors = subject.plant.sampled.size();
  if (sensors < 2) return;
  set_sensor_times(subject, std::vector<SamplingTimes>(sensors, {subject.T1, subject.T2}));
}

void add_event_times(CommandLine& command, const std::string& source,
                     EventTimeArguments& arguments) {
  command
      .option("--T1 SECONDS", arguments.T1,
              "Shortest time between events, instead of " + source + "'s [s]; 0 for any")
      .check(number_at_least(0));
  command
      .option("--T2 SECONDS", arguments.T2,
              "Longest time between events, instead of " + source + "'s [s]; inf for none")
      .check(number_above_or_infinite(0));
  command
      .option("--cells NUMBER", arguments.cells,
              "Of a proof that depends on timers: cells of each of them (default: refined until "
              "that gains less than 1 %)")
      .check(whole_number_at_least(1));
  command
      .option("--average-dwell-time TAU N0", arguments.average_dwell_time,
              "Instead of both: at most t / TAU + N0 jumps within any time t [s]")
      .check(any_number());
  command
      .option("--reverse-average-dwell-time TAU N0", arguments.reverse_average_dwell_time,
              "Instead of both: at least t / TAU - N0 jumps within any time t [s]")
      .check(any_number());
}

void take_event_times(const EventTimeArguments& arguments, CertificateSubject& subject) {
  const bool has_dwell_time = arguments.average_dwell_time || arguments.reverse_average_dwell_time;
  const bool has_bounds = arguments.T1 || !arguments.T2.empty();
  if ((has_dwell_time && has_bounds) ||
      (arguments.average_dwell_time && arguments.reverse_average_dwell_time)) {
    throw RequestError(
        "expected one of --T1 and --T2, --average-dwell-time and --reverse-average-dwell-time, "
        "found several");
  }
  if (has_bounds && subject.dwell_time) {
    subject.dwell_time.reset();
    subject.T2 = 0.0;
  }
  if (has_bounds) require_common_times(subject);
  if (arguments.T1) subject.T1 = *arguments.T1;
  if (!arguments.T2.empty()) subject.T2 = std::strtod(arguments.T2.c_str(), nullptr);
  if (has_bounds) {
    give_to_all_sensors(subject);
    subject.timer_nodes.clear();
  }
  if (arguments.cells && subject.T2 > 0.0 && std::isfinite(subject.T2)) {
    subject = with_readable_cells(subject, *arguments.cells);
  }
  if (has_dwell_time) {
    subject.T1 = 0.0;
    subject.T2 = std::numeric_limits<double>::infinity();
    subject.dwell_time =
        arguments.average_dwell_time
            ? dwell_time_of(DwellTime::Kind::kAverage, *arguments.average_dwell_time)
            : dwell_time_of(DwellTime::Kind::kReverseAverage,
                            *arguments.reverse_average_dwell_time);
  }
  if (subject.T2 > 0.0 && subject.T1 > subject.T2) {
    char text[96];
    std::snprintf(text, sizeof text, "T1 = %.9g s is larger than T2 = %.9g s", subject.T1,
                  subject.T2);
    throw RequestError(text);
  }
}

}  // namespace sampled_data_observers
