#pragma once

#include <algorithm>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Tells when time went back. By no more than a tolerance it is taken for a correction of the
/// clock, which changes nothing.
class ClockJumps {
 public:
  /// @param tolerance  [ns]
  explicit ClockJumps(Duration tolerance) : tolerance_(tolerance) {}

  /// Takes the time. Returns by how much it went back [ns]; 0 where it did not, or is corrected.
  Duration note(Stamp now) {
    const Duration back = latest_ - now;
    if (back > tolerance_) {
      latest_ = now;
      return back;
    }
    latest_ = std::max(latest_, now);
    return 0;
  }

 private:
  Duration tolerance_;
  Stamp latest_ = 0;
};

}  // namespace sampled_data_observers
