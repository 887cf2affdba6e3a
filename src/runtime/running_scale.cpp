#include "sampled_data_observers/runtime/running_scale.h"

#include <algorithm>

namespace sampled_data_observers {

RunningScale::RunningScale(std::size_t size) : recent_(size) { sorted_.reserve(size); }

void RunningScale::add(double value) {
  if (is_full()) {
    sorted_.erase(std::lower_bound(sorted_.begin(), sorted_.end(), recent_[next_]));
  }
  sorted_.insert(std::upper_bound(sorted_.begin(), sorted_.end(), value), value);
  recent_[next_] = value;
  next_ = (next_ + 1) % recent_.size();
}

double RunningScale::deviation() const {
  constexpr double kOfNormal = 1.4826;  // 1 / (the 3/4 quantile of the normal distribution)
  const double centre = median();
  // Outwards from the median, the nearer neighbour first: the last one of half of all.
  std::size_t below = sorted_.size() / 2;
  std::size_t above = below + 1;
  double deviation = 0.0;
  for (std::size_t count = sorted_.size() / 2; count > 0; --count) {
    const bool is_below = above == sorted_.size() ||
                          (below > 0 && centre - sorted_[below - 1] < sorted_[above] - centre);
    deviation = is_below ? centre - sorted_[--below] : sorted_[above++] - centre;
  }
  return kOfNormal * deviation;
}

void RunningScale::clear() {
  sorted_.clear();
  next_ = 0;
}

}  // namespace sampled_data_observers
