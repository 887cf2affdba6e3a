#include "sampled_data_observers/runtime/jump_detector.h"

#include <cmath>

namespace sampled_data_observers {

JumpDetector::Finding JumpDetector::add(Stamp stamp, double value) {
  if (stamp <= stamp_) return Finding::kOutOfOrder;
  if (!std::isfinite(value)) return Finding::kNotFinite;
  const Stamp previous_stamp = stamp_;
  const double previous_height = height_;
  stamp_ = stamp;
  height_ = options_.rising ? value - options_.threshold : options_.threshold - value;

  if (height_ < 0.0) {
    if (height_ <= -options_.hysteresis) is_armed_ = true;
    return Finding::kNothing;
  }
  if (!is_armed_) return Finding::kNothing;
  is_armed_ = false;
  const double share = previous_height / (previous_height - height_);
  const auto elapsed = static_cast<double>(stamp_ - previous_stamp);
  const Stamp crossing = previous_stamp + std::llround(share * elapsed);
  if (crossing_ > 0 && crossing - crossing_ < options_.refractory) return Finding::kNothing;
  crossing_ = crossing;
  return Finding::kJump;
}

void JumpDetector::restart() { *this = JumpDetector(options_); }

}  // namespace sampled_data_observers
