#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

// A state is one array of numbers, as is the workspace of the maps that act on it. StateLayout
// hands out slots of such an array while a system is built; a slot knows its place ever after, and
// what the numbers there mean. The array itself is whoever's it is.

/// A vector, or a matrix column by column.
class VectorSlot {
 public:
  VectorSlot() = default;
  /// From the entry `first` of a state on.
  VectorSlot(Eigen::Index first, Eigen::Index size) : first_(first), size_(size) {}

  /// Number of entries.
  Eigen::Index size() const { return size_; }
  /// Its entries in a state.
  double* of(double* state) const { return state + first_; }
  /// The same of a state that is only read.
  const double* of(const double* state) const { return state + first_; }
  /// Copies size() values, which do not overlap it, into a state.
  void set(const double* values, double* state) const { std::copy_n(values, size_, of(state)); }
  /// Sets all its entries to one value.
  void fill(double value, double* state) const { std::fill_n(of(state), size_, value); }

  /// `size` of its entries, from the one at `offset` on.
  VectorSlot part(Eigen::Index offset, Eigen::Index size) const {
    assert(offset >= 0 && size >= 0 && offset + size <= size_);
    return {first_ + offset, size};
  }

 private:
  Eigen::Index first_ = 0;
  Eigen::Index size_ = 0;
};

/// One number.
class NumberSlot {
 public:
  NumberSlot() = default;
  /// At one place of a state.
  explicit NumberSlot(Eigen::Index place) : place_(place) {}

  /// Its value in a state.
  double of(const double* state) const { return state[place_]; }
  /// Sets it in a state.
  void set(double value, double* state) const { state[place_] = value; }

 private:
  Eigen::Index place_ = 0;
};

/// A yes or no.
class FlagSlot {
 public:
  FlagSlot() = default;
  /// At one place of a state.
  explicit FlagSlot(Eigen::Index place) : place_(place) {}

  /// Its value in a state.
  bool of(const double* state) const { return state[place_] != 0.0; }
  /// Sets it in a state.
  void set(bool value, double* state) const { state[place_] = value ? 1.0 : 0.0; }

 private:
  Eigen::Index place_ = 0;
};

/// A row of them.
class FlagsSlot {
 public:
  FlagsSlot() = default;
  /// From the entry `first` of a state on.
  FlagsSlot(Eigen::Index first, std::size_t size) : first_(first), size_(size) {}

  /// Number of flags.
  std::size_t size() const { return size_; }
  /// One of them.
  FlagSlot operator[](std::size_t i) const {
    assert(i < size_);
    return FlagSlot(first_ + static_cast<Eigen::Index>(i));
  }
  /// Sets all in a state.
  void fill(bool value, double* state) const {
    std::fill_n(state + first_, size_, value ? 1.0 : 0.0);
  }

 private:
  Eigen::Index first_ = 0;
  std::size_t size_ = 0;
};

/// One of the values of an enumeration, or a position in a list.
template <class T>
class ChoiceSlot {
 public:
  ChoiceSlot() = default;
  /// At one place of a state.
  explicit ChoiceSlot(Eigen::Index place) : place_(place) {}

  /// Its value in a state.
  T of(const double* state) const {
    return static_cast<T>(static_cast<std::int64_t>(state[place_]));
  }
  /// Sets it in a state.
  void set(T value, double* state) const {
    state[place_] = static_cast<double>(static_cast<std::int64_t>(value));
  }

 private:
  Eigen::Index place_ = 0;
};

/// A mode of the plant, as its position among all.
using ModeSlot = ChoiceSlot<std::size_t>;

/// The time since something [ns], up to a limit at which it stays. A sum of nanoseconds is exact up
/// to 2^53 (104 days), however the time is divided.
class TimerSlot {
 public:
  TimerSlot() = default;
  /// At one place of a state, with its limit [ns].
  TimerSlot(Eigen::Index place, double limit) : place_(place), limit_(limit) {}

  /// The time in a state [ns].
  double of(const double* state) const { return state[place_]; }
  /// Whether it has come to its limit.
  bool is_over(const double* state) const { return state[place_] >= limit_; }
  /// Sets it to zero.
  void restart(double* state) const { state[place_] = 0.0; }
  /// Sets it to its limit.
  void expire(double* state) const { state[place_] = limit_; }
  /// Lets time pass, `duration` >= 0.
  void advance(Duration duration, double* state) const {
    state[place_] = std::min(limit_, state[place_] + static_cast<double>(duration));
  }

 private:
  Eigen::Index place_ = 0;
  double limit_ = 0.0;
};

/// Hands out slots, one behind the other.
class StateLayout {
 public:
  /// Number of entries handed out.
  Eigen::Index size() const { return size_; }

  /// A vector, or a matrix, of so many entries.
  VectorSlot vector(Eigen::Index entries) { return {take(entries), entries}; }
  /// A number.
  NumberSlot number() { return NumberSlot(take(1)); }
  /// A flag.
  FlagSlot flag() { return FlagSlot(take(1)); }
  /// So many flags.
  FlagsSlot flags(std::size_t count) { return {take(static_cast<Eigen::Index>(count)), count}; }
  /// One of the values of T.
  template <class T>
  ChoiceSlot<T> choice() {
    return ChoiceSlot<T>(take(1));
  }
  /// A mode.
  ModeSlot mode() { return choice<std::size_t>(); }
  /// A timer; without a limit, it goes on for ever.
  TimerSlot timer(double limit = std::numeric_limits<double>::infinity()) {
    return timers_.emplace_back(take(1), limit);
  }

  /// Lets time pass for all timers, `duration` >= 0.
  void advance_timers(Duration duration, double* state) const {
    for (const TimerSlot& timer : timers_) timer.advance(duration, state);
  }

  /// All that was handed out from a size on.
  VectorSlot since(Eigen::Index size) const {
    assert(size <= size_);
    return {size, size_ - size};
  }

 private:
  Eigen::Index take(Eigen::Index entries) {
    assert(entries >= 0);
    size_ += entries;
    return size_ - entries;
  }

  Eigen::Index size_ = 0;
  std::vector<TimerSlot> timers_;  ///< all that were handed out
};

}  // namespace sampled_data_observers
