#pragma once

#include <optional>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Which estimates are due: the whole multiples of a period, each once, in increasing order, as
/// soon as time has passed them by a fixed delay. A caller that comes late gets the stamps it
/// missed, but none further back than `backlog`. Other stamps may be put between them.
class PublicationGrid {
 public:
  /// @pre period > 0, delay >= 0, backlog >= 0, all in ns
  PublicationGrid(Duration period, Duration delay, Duration backlog)
      : period_(period), delay_(delay), backlog_(backlog) {}

  /// The next stamp due at `now`, none before `earliest`.
  std::optional<Stamp> next(Stamp now, Stamp earliest) {
    const std::optional<Stamp> stamp = peek(now, earliest);
    if (stamp) last_ = stamp;
    return stamp;
  }

  /// What next() would give.
  std::optional<Stamp> peek(Stamp now, Stamp earliest) const {
    const Stamp due = now - delay_;
    const Stamp from = earliest > due - backlog_ ? earliest : due - backlog_;
    if (from < 0) return std::nullopt;
    Stamp stamp = first_multiple_from(from, period_);
    if (last_ && stamp <= *last_) stamp = first_multiple_from(*last_ + 1, period_);
    if (stamp > due) return std::nullopt;
    return stamp;
  }

  /// The time at which the first stamp after those due at `now` becomes due.
  Stamp next_due_time(Stamp now) const {
    const Stamp due = now - delay_;
    return first_multiple_from(due < 0 ? 0 : due + 1, period_) + delay_;
  }

  /// Puts the stamp `now` between those of the grid, after next() gave all that are due. Returns
  /// false where it would not come after the last one.
  bool insert(Stamp now) {
    if (last_ && now <= *last_) return false;
    last_ = now;
    return true;
  }

  /// Gives up the stamps missed so far.
  void skip_to(Stamp now) {
    const Stamp due = now - delay_;
    if (due >= 0 && (!last_ || *last_ < due)) last_ = due;
  }

  /// When time went back to `now`, lets the stamps after it come again.
  void restart(Stamp now) {
    if (last_ && *last_ > now) last_.reset();
  }

 private:
  Duration period_;
  Duration delay_;
  Duration backlog_;
  std::optional<Stamp> last_;
};

}  // namespace sampled_data_observers
