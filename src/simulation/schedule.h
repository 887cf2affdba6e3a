#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"
#include "simulation/random_numbers.h"

namespace sampled_data_observers {

/// When something happens in a simulation; times since its start.
struct Schedule {
  enum class Kind {
    kUniform,   ///< intervals uniform in [T1, T2], the first one too
    kSine,      ///< ferrante2019 (52); first at T2
    kPeriodic,  ///< at whole multiples of T1, from `first` on
    kListed     ///< at `times`
  };

  Kind kind = Kind::kUniform;
  Duration T1 = 0;
  Duration T2 = 0;
  Duration first = 0;
  /// Strictly increasing.
  std::vector<Duration> times;

  /// Whether both are described alike.
  bool operator==(const Schedule& other) const {
    return kind == other.kind && T1 == other.T1 && T2 == other.T2 && first == other.first &&
           times == other.times;
  }
};

/// The times of a schedule, one after the other.
class ScheduledTimes {
 public:
  ScheduledTimes(Schedule schedule, RandomNumbers random)
      : schedule_(std::move(schedule)), random_(random) {}

  /// The next time, later than the one before; nothing when there is none any more.
  std::optional<Duration> next();

 private:
  Schedule schedule_;
  RandomNumbers random_;
  std::optional<Duration> last_;
  std::size_t taken_ = 0;
};

}  // namespace sampled_data_observers
