#pragma once

#include <vector>

#include "sampled_data_observers/config/topic_config.h"
#include "sampled_data_observers/hybrid/event.h"

namespace sampled_data_observers {

/// The values of events as a source's configuration corrects them: see ValueCorrection.
class CorrectedValues {
 public:
  explicit CorrectedValues(const TopicSource& source)
      : correction_(source.correction), values_(source.size) {}

  /// Corrects the values of an event, which live here then until the next call; those of another
  /// number than configured stay. Returns whether all are within their limits, or are no numbers.
  bool apply(Event& event) {
    if (correction_.is_empty() || event.size != static_cast<Eigen::Index>(values_.size())) {
      return true;
    }
    bool is_within = true;
    for (Eigen::Index i = 0; i < event.size; ++i) {
      double value = event.values[i];
      if (correction_.scale.size() > 0) value *= correction_.scale(i);
      if (correction_.offset.size() > 0) value += correction_.offset(i);
      values_[static_cast<std::size_t>(i)] = value;
      if (correction_.limits.empty()) continue;
      const Eigen::Vector2d& limits = correction_.limits[static_cast<std::size_t>(i)];
      if (value < limits(0) || value > limits(1)) is_within = false;
    }
    event.values = values_.data();
    return is_within;
  }

 private:
  ValueCorrection correction_;
  std::vector<double> values_;
};

}  // namespace sampled_data_observers
