#include "simulation/sampling_check.h"

#include <algorithm>
#include <optional>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {
namespace {

/// Nothing for a list of less than two.
std::optional<SamplingTimes> times_of(const Schedule& schedule) {
  if (schedule.kind == Schedule::Kind::kPeriodic) {
    return SamplingTimes{to_seconds(schedule.T1), to_seconds(schedule.T1)};
  }
  if (schedule.kind != Schedule::Kind::kListed) {
    return SamplingTimes{to_seconds(schedule.T1), to_seconds(schedule.T2)};
  }
  if (schedule.times.size() < 2) return std::nullopt;
  Duration shortest = kNoLongestTime;
  Duration longest = 0;
  for (std::size_t i = 1; i < schedule.times.size(); ++i) {
    const Duration time = schedule.times[i] - schedule.times[i - 1];
    shortest = std::min(shortest, time);
    longest = std::max(longest, time);
  }
  return SamplingTimes{to_seconds(shortest), to_seconds(longest)};
}

void compare(const std::string& place, const std::optional<Schedule>& schedule,
             const std::optional<SamplingTimes>& bounds, std::vector<std::string>& found) {
  const auto times = schedule ? times_of(*schedule) : std::nullopt;
  if (!times || !bounds || is_inside(*times, *bounds)) return;
  found.push_back("scenario/" + place + "/schedule has times in " + to_text(*times) +
                  ", not all inside " + to_text(*bounds) + ", those of 'sampling'");
}

}  // namespace

std::vector<std::string> schedules_outside(const Scenario& scenario,
                                           const SamplingConfig& sampling) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    compare("sensors/" + scenario.plant->sensors()[i].name, scenario.sensors[i].schedule,
            sampling.sensors[i], found);
  }
  if (scenario.jumps) compare("jumps", scenario.jumps->schedule, sampling.jumps, found);
  return found;
}

}  // namespace sampled_data_observers
