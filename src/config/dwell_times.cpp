#include "config/dwell_times.h"

#include <cmath>
#include <string>

namespace sampled_data_observers {
namespace {

constexpr double kShortestTau = 1e-9;  // s: one tick of the clock
constexpr double kLongestTime = 1e6;   // s
constexpr std::size_t kMostN0 = 1000000;

DwellTimes::Average read_average(ConfigSection section) {
  DwellTimes::Average average;
  average.tau = from_seconds(section.number_in("tau", kShortestTau, kLongestTime, std::nullopt));
  section.number("N0");
  average.N0 = static_cast<double>(section.count("N0", 1, kMostN0, 1));
  section.finish();
  return average;
}

}  // namespace

std::optional<DwellTimes> read_dwell_times(ConfigSection& jumps) {
  DwellTimes times;
  const bool has_interval = jumps.has("dwell_time");
  if (has_interval) {
    const Eigen::Vector2d interval = jumps.interval_in("dwell_time", 0.0, kLongestTime);
    times.shortest = from_seconds(interval(0));
    if (std::isfinite(interval(1))) times.longest = from_seconds(interval(1));
  }
  if (jumps.has("average_dwell_time")) {
    times.average = read_average(jumps.section("average_dwell_time"));
  }
  if (jumps.has("reverse_average_dwell_time")) {
    times.reverse_average = read_average(jumps.section("reverse_average_dwell_time"));
  }
  if (!has_interval && !times.average && !times.reverse_average) return std::nullopt;
  return times;
}

}  // namespace sampled_data_observers
