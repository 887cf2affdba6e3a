#pragma once

#include <cstdlib>
#include <optional>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Keeps stamps that lie a least interval apart.
class ThinnedStamps {
 public:
  /// @param min_interval  in nanoseconds; 0 keeps all
  explicit ThinnedStamps(Duration min_interval) : min_interval_(min_interval) {}

  /// Whether `stamp` is kept: not nearer to the last one kept than the interval, on either side, so
  /// that a clock that was set back starts anew.
  bool keep(Stamp stamp) {
    if (last_ && std::abs(stamp - *last_) < min_interval_) return false;
    last_ = stamp;
    return true;
  }

 private:
  Duration min_interval_;
  std::optional<Stamp> last_;
};

}  // namespace sampled_data_observers
