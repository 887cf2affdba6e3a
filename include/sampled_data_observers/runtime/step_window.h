#pragma once

#include <cstddef>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// The last 2 m samples of a signal, and by how much it changed in their middle: the mean of the m
/// newest less that of the m before. Of a step in white noise, that is the estimate of its height
/// with the least variance. Allocates nothing after construction.
class StepWindow {
 public:
  /// One of the signal.
  struct Sample {
    Stamp stamp = 0;      ///< when it was taken
    double value = 0.0;   ///< of the signal
    double energy = 0.0;  ///< what is told beside it
  };

  /// @param half  m, at least 1
  explicit StepWindow(std::size_t half) : samples_(2 * half) {}

  /// m
  std::size_t half() const { return samples_.size() / 2; }
  /// The sample takes the place of the oldest one.
  void add(const Sample& sample);
  /// How many samples there are, up to 2 m.
  std::size_t count() const { return count_; }
  /// Whether they are 2 m.
  bool is_full() const { return count_ == samples_.size(); }

  /// Units of the signal. @pre is_full()
  double change() const;
  /// The last sample before the change. @pre count() > half()
  const Sample& before() const { return from_newest(half()); }
  /// The first sample after it. @pre count() >= half()
  const Sample& after() const { return from_newest(half() - 1); }

  /// Forgets all samples.
  void clear();

 private:
  const Sample& from_newest(std::size_t i) const {
    return samples_[(next_ + samples_.size() - 1 - i) % samples_.size()];
  }

  /// Round about; the oldest at next_.
  std::vector<Sample> samples_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace sampled_data_observers
