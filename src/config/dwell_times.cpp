#include "config/dwell_times.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/event_times.h"

namespace sampled_data_observers {
namespace {

constexpr double kLongestDwellTime = 1e6;  // s

}  // namespace

std::optional<DwellTimes> read_dwell_times(ConfigSection& jumps) {
  DwellTimes times;
  const bool has_interval = jumps.has("dwell_time");
  if (has_interval) {
    const Eigen::Vector2d interval = jumps.interval_in("dwell_time", 0.0, kLongestDwellTime);
    times.shortest = from_seconds(interval(0));
    if (std::isfinite(interval(1))) times.longest = from_seconds(interval(1));
  }
  if (jumps.has(kAverageDwellTime)) {
    times.average =
        average_of(read_dwell_time(jumps.section(kAverageDwellTime), DwellTime::Kind::kAverage));
  }
  if (jumps.has(kReverseAverageDwellTime)) {
    times.reverse_average = average_of(
        read_dwell_time(jumps.section(kReverseAverageDwellTime), DwellTime::Kind::kReverseAverage));
  }
  if (!has_interval && !times.average && !times.reverse_average) return std::nullopt;
  return times;
}

DwellTimes::Average average_of(const DwellTime& dwell_time) {
  const double exact = dwell_time.tau * static_cast<double>(kNanosecondsPerSecond);
  double tau = std::round(exact);
  if (std::abs(exact - tau) > 2.0 * std::numeric_limits<double>::epsilon() * exact) {
    tau = dwell_time.kind == DwellTime::Kind::kAverage ? std::ceil(exact) : std::floor(exact);
  }
  return {static_cast<Duration>(std::max(1.0, tau)), dwell_time.N0};
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
