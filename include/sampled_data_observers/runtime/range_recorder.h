#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

namespace sampled_data_observers {

/// What is known of some recorded values.
struct Range {
  /// How many there were.
  std::uint64_t count = 0;
  /// In the unit of the values.
  std::int64_t sum = 0;
  /// Of no meaning where count is 0.
  std::int64_t smallest = std::numeric_limits<std::int64_t>::max();
  /// Of no meaning where count is 0.
  std::int64_t largest = std::numeric_limits<std::int64_t>::min();

  /// 0 where nothing was recorded.
  double mean() const {
    return count == 0 ? 0.0 : static_cast<double>(sum) / static_cast<double>(count);
  }

  /// Joins what is known of other values.
  void add(const Range& other) {
    count += other.count;
    sum += other.sum;
    if (other.smallest < smallest) smallest = other.smallest;
    if (other.largest > largest) largest = other.largest;
  }
};

/// Count, sum and extremes of a quantity. Any thread may record and take: there is no lock, no
/// allocation and no waiting. A value that is recorded while another thread takes may count in one
/// range and sum in the next, which is good enough for people to read.
class RangeRecorder {
 public:
  /// Takes in one value, in the unit that all of them have.
  void record(std::int64_t value) noexcept {
    count_.fetch_add(1, std::memory_order_relaxed);
    sum_.fetch_add(value, std::memory_order_relaxed);
    std::int64_t seen = smallest_.load(std::memory_order_relaxed);
    while (value < seen &&
           !smallest_.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
    seen = largest_.load(std::memory_order_relaxed);
    while (value > seen &&
           !largest_.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
  }

  /// What was recorded since the last call.
  Range take() noexcept {
    const Range none;
    Range range;
    range.count = count_.exchange(0, std::memory_order_relaxed);
    range.sum = sum_.exchange(0, std::memory_order_relaxed);
    range.smallest = smallest_.exchange(none.smallest, std::memory_order_relaxed);
    range.largest = largest_.exchange(none.largest, std::memory_order_relaxed);
    return range;
  }

 private:
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::int64_t> sum_{0};
  std::atomic<std::int64_t> smallest_{Range().smallest};
  std::atomic<std::int64_t> largest_{Range().largest};
};

}  // namespace sampled_data_observers
