#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// What an event does to the observer. The numbers are the order in which events of equal stamp
/// take effect: a new input holds from its stamp on, so it comes first; a plant jump has priority
/// over a sample, so a sample stamped at the instant of a jump measures the state after it.
enum class EventKind : std::uint8_t { kInput = 0, kJump = 1, kSample = 2 };

/// One event, as a view: the values belong to whoever made it.
struct Event {
  Stamp stamp = 0;
  EventKind kind = EventKind::kSample;
  /// Index of the sensor for samples, 0 otherwise.
  int channel = 0;
  const double* values = nullptr;
  Eigen::Index size = 0;

  Eigen::Map<const Eigen::VectorXd> vector() const { return {values, size}; }
};

/// Total order of events: by stamp, then kind, channel, number of values, and values in
/// lexicographic order. Negative, zero or positive as for strcmp; zero means a duplicate.
/// @pre all values are finite
int compare(const Event& a, const Event& b);

}  // namespace sampled_data_observers
