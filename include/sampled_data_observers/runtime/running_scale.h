#pragma once

#include <cstddef>
#include <vector>

namespace sampled_data_observers {

/// Centre and spread of the last values of a signal, which outliers hardly move as long as they are
/// the lesser part: the median, and the median deviation from it.
///
/// Adding a value moves as many as there are; nothing is allocated after construction.
class RunningScale {
 public:
  /// @param size  how many values count, at least 1
  explicit RunningScale(std::size_t size);

  /// The value takes the place of the oldest one. @pre it is finite
  void add(double value);

  /// Whether there are as many values as count: before, nothing is known.
  bool is_full() const { return sorted_.size() == recent_.size(); }

  /// The median, the upper one of an even number. @pre is_full()
  double median() const { return sorted_[sorted_.size() / 2]; }

  /// 1.4826 times the median of the deviations from the median: the standard deviation where the
  /// values are normally distributed. @pre is_full()
  double deviation() const;

  /// Forgets all values.
  void clear();

 private:
  /// As they came, round about; the oldest at next_.
  std::vector<double> recent_;
  std::size_t next_ = 0;
  std::vector<double> sorted_;
};

}  // namespace sampled_data_observers
