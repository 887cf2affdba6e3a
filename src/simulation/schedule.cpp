#include "simulation/schedule.h"

#include <algorithm>
#include <cmath>

namespace sampled_data_observers {

std::optional<Duration> ScheduledTimes::next() {
  const double T1 = to_seconds(schedule_.T1);
  const double T2 = to_seconds(schedule_.T2);
  switch (schedule_.kind) {
    case Schedule::Kind::kUniform:
      last_ = last_.value_or(0) + random_.whole(schedule_.T1, schedule_.T2);
      break;
    case Schedule::Kind::kSine:
      if (!last_) {
        last_ = schedule_.T2;
      } else {
        const double interval =
            (T2 - T1) / 2.0 * std::sin(10.0 * to_seconds(*last_)) + (T2 + T1) / 2.0;
        // Rounding must lead neither out of the bounds nor to an interval of 0.
        *last_ += std::clamp(from_seconds(interval), schedule_.T1, schedule_.T2);
      }
      break;
    case Schedule::Kind::kPeriodic:
      last_ = last_ ? *last_ + schedule_.T1 : schedule_.first;
      break;
    case Schedule::Kind::kListed:
      if (taken_ == schedule_.times.size()) return std::nullopt;
      last_ = schedule_.times[taken_++];
      break;
  }
  return last_;
}

}  // namespace sampled_data_observers
