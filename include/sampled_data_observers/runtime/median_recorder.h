#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

namespace sampled_data_observers {

/// The median of the last values of a quantity, kLength of them at most. Any thread may record, and
/// one at a time take: there is no lock, no allocation and no waiting. A value that is recorded
/// while another thread takes may count in the next median, which is good enough for people to
/// read.
class MedianRecorder {
 public:
  /// How many values count.
  static constexpr std::uint64_t kLength = 63;

  /// Takes in one value, in the unit that all of them have.
  void record(std::int64_t value) noexcept {
    const std::uint64_t place = count_.fetch_add(1, std::memory_order_relaxed);
    values_[place % kLength].store(value, std::memory_order_relaxed);
  }

  /// The lower median of what was recorded since the last call; nothing where nothing was.
  std::optional<std::int64_t> take() noexcept {
    const std::uint64_t count = count_.exchange(0, std::memory_order_relaxed);
    const auto size = static_cast<std::ptrdiff_t>(std::min(count, kLength));
    if (size == 0) return std::nullopt;
    std::array<std::int64_t, kLength> values{};
    std::transform(values_.begin(), values_.end(), values.begin(),
                   [](const auto& value) { return value.load(std::memory_order_relaxed); });
    const auto middle = values.begin() + (size - 1) / 2;
    std::nth_element(values.begin(), middle, values.begin() + size);
    return *middle;
  }

 private:
  std::array<std::atomic<std::int64_t>, kLength> values_{};
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace sampled_data_observers
