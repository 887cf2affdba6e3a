#include "simulation/jump_detection.h"

#include <algorithm>

namespace sampled_data_observers {

JumpDetection::JumpDetection(const DetectionFaults& faults, RandomNumbers of_jumps,
                             RandomNumbers of_alarms)
    : faults_(faults), of_jumps_(of_jumps), of_alarms_(of_alarms) {
  if (faults_.false_rate > 0.0) await_false_alarm();
}

std::vector<Duration> JumpDetection::tell() {
  const bool missed = of_jumps_.chance(faults_.missed);
  const bool twice = of_jumps_.chance(faults_.duplicate);
  std::vector<Duration> errors = {stamp_error(), stamp_error()};
  if (!twice) errors.pop_back();
  if (missed) errors.clear();
  std::sort(errors.begin(), errors.end());
  if (missed) ++tally_.missed;
  if (errors.size() > 1) ++tally_.doubled;
  const auto is_off = [](Duration error) { return error != 0; };
  if (std::any_of(errors.begin(), errors.end(), is_off)) ++tally_.off;
  return errors;
}

void JumpDetection::pass_false_alarm() {
  ++tally_.false_alarms;
  await_false_alarm();
}

void JumpDetection::await_false_alarm() {
  // Of a Poisson process; two of one nanosecond would be one, and one later than any scenario ends
  // is none.
  constexpr double kNever = 1e7;  // s
  const double interval = std::min(of_alarms_.exponential() / faults_.false_rate, kNever);
  false_alarm_ = false_alarm_.value_or(0) + std::max<Duration>(from_seconds(interval), 1);
}

std::size_t JumpDetection::choose(std::size_t count) {
  return static_cast<std::size_t>(of_alarms_.whole(0, static_cast<std::int64_t>(count) - 1));
}

}  // namespace sampled_data_observers
