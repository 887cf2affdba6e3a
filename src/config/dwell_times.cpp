#include "config/dwell_times.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

DwellTimes::Average average_of(const DwellTime& claimed) {
  const double exact = claimed.tau * static_cast<double>(kNanosecondsPerSecond);
  double tau = std::round(exact);
  if (std::abs(exact - tau) > 2.0 * std::numeric_limits<double>::epsilon() * exact) {
    tau = claimed.kind == DwellTime::Kind::kAverage ? std::ceil(exact) : std::floor(exact);
  }
  return {static_cast<Duration>(std::max(1.0, tau)), claimed.N0};
}

void watch(const DwellTime& claimed, std::optional<DwellTimes>& times) {
  if (!times) times = DwellTimes();
  const bool is_average = claimed.kind == DwellTime::Kind::kAverage;
  auto& watched = is_average ? times->average : times->reverse_average;
  const DwellTimes::Average own = average_of(claimed);
  if (!watched) {
    watched = own;
    return;
  }
  watched->tau = is_average ? std::max(watched->tau, own.tau) : std::min(watched->tau, own.tau);
  watched->N0 = std::min(watched->N0, own.N0);
}

}  // namespace sampled_data_observers
