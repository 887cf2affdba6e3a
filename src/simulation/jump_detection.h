#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"
#include "simulation/random_numbers.h"

namespace sampled_data_observers {

/// How what detects the jumps on a robot goes wrong.
struct DetectionFaults {
  /// Stamps are off by errors uniform in ± it [ns].
  Duration stamp_error = 0;
  /// Probabilities, in [0, 1], that a jump is not told of, and that one that is told of is told of
  /// twice.
  double missed = 0.0;
  double duplicate = 0.0;
  /// Mean number of jumps that never happened but are told of, per second.
  double false_rate = 0.0;
};

/// What was told wrongly.
struct DetectionTally {
  std::uint64_t missed = 0;
  std::uint64_t doubled = 0;
  std::uint64_t off = 0;  ///< told with a stamp that is off, or two
  std::uint64_t false_alarms = 0;

  bool is_empty() const { return missed + doubled + off + false_alarms == 0; }
};

/// Decides which jumps are told of, and when.
class JumpDetection {
 public:
  /// @param of_jumps   what is drawn for each jump
  /// @param of_alarms  what is drawn for jumps that never happened
  JumpDetection(const DetectionFaults& faults, RandomNumbers of_jumps, RandomNumbers of_alarms);

  /// For the next jump: the error of each stamp with which it is told of [ns], the earliest first;
  /// none where it is missed. The same number of random numbers is drawn for each jump.
  std::vector<Duration> tell();

  /// When a jump is told of that never happens, since the start [ns]; later than the one before.
  std::optional<Duration> false_alarm() const { return false_alarm_; }
  /// On to the next such time.
  void pass_false_alarm();

  /// Of the jumps so far, and of the false alarms passed.
  const DetectionTally& tally() const { return tally_; }

  /// A position below `count` by chance, for the present false alarm.
  std::size_t choose(std::size_t count);

 private:
  void await_false_alarm();
  Duration stamp_error() { return of_jumps_.whole(-faults_.stamp_error, faults_.stamp_error); }

  DetectionFaults faults_;
  RandomNumbers of_jumps_;
  RandomNumbers of_alarms_;
  std::optional<Duration> false_alarm_;
  DetectionTally tally_;
};

}  // namespace sampled_data_observers
