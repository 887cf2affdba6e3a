#include "sampled_data_observers/runtime/jump_detector.h"

#include <algorithm>
#include <cmath>

#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {
namespace {

bool is_usable(double value) { return std::abs(value) <= kLargestValue; }

}  // namespace

JumpDetector::JumpDetector(const Options& options) : options_(options) {
  const bool is_relative = options.kind == Kind::kDeviation || options.kind == Kind::kStep;
  if (is_relative && options.noise_factor > 0.0) scale_.emplace(options.noise_samples);
  if (options.kind == Kind::kStep) steps_.emplace(options.window);
}

JumpDetector::Finding JumpDetector::add(Stamp stamp, double value, double energy) {
  if (stamp <= stamp_) return Finding::kOutOfOrder;
  if (!is_usable(value) || !is_usable(energy)) return Finding::kNotFinite;
  double height = 0.0;
  switch (options_.kind) {
    case Kind::kStep:
      return look_for_step({stamp, value, energy});
    case Kind::kDeviation:
      return look_for_crossing(stamp, excess_of(value), energy);
    case Kind::kThreshold:
      height = options_.direction == Direction::kRising ? value - options_.threshold
                                                        : options_.threshold - value;
      break;
    case Kind::kGuard:
      height = guard_of(stamp, value);
      if (!is_usable(height)) return Finding::kNotFinite;
      break;
  }
  return look_for_crossing(stamp, height, energy);
}

double JumpDetector::guard_of(Stamp stamp, double value) const {
  const double arguments[] = {value, since_ > 0 ? to_seconds(stamp - since_) : 0.0};
  double guard = 0.0;
  options_.guard->evaluate(arguments, nullptr, &guard);
  return guard;
}

/// By how much a value, or a change, exceeds the least one that counts; nothing while the running
/// scale is not known.
std::optional<double> JumpDetector::excess_of(double value) {
  double least = options_.threshold;
  double size = value;
  if (scale_) {
    const bool is_known = scale_->is_full();
    if (is_known) {
      size -= scale_->median();
      least = std::max(least, options_.noise_factor * scale_->deviation());
    }
    scale_->add(value);
    if (!is_known) return std::nullopt;
  }
  if (options_.direction == Direction::kFalling) size = -size;
  if (options_.direction == Direction::kEither) size = std::abs(size);
  return size - least;
}

JumpDetector::Finding JumpDetector::look_for_crossing(Stamp stamp, std::optional<double> height,
                                                      double energy) {
  const Stamp previous_stamp = stamp_;
  const double previous_height = height_;
  const double energy_before = energy_;
  stamp_ = stamp;
  height_ = height.value_or(0.0);
  energy_ = std::max(energy_, energy);
  if (since_ == 0) since_ = stamp;

  if (!height) return Finding::kNothing;
  if (height_ < 0.0) {
    if (height_ <= -options_.hysteresis) is_armed_ = true;
    return Finding::kNothing;
  }
  if (!is_armed_) return Finding::kNothing;
  is_armed_ = false;
  const double share = previous_height / (previous_height - height_);
  const auto elapsed = static_cast<double>(stamp_ - previous_stamp);
  const Stamp crossing = previous_stamp + std::llround(share * elapsed);
  return counts(crossing, energy_before) ? found(crossing, energy) : Finding::kNothing;
}

JumpDetector::Finding JumpDetector::look_for_step(const StepWindow::Sample& sample) {
  stamp_ = sample.stamp;
  steps_->add(sample);
  if (steps_->count() <= steps_->half()) return Finding::kNothing;
  const StepWindow::Sample& before = steps_->before();
  energy_ = std::max(energy_, before.energy);
  if (!steps_->is_full()) return Finding::kNothing;

  const std::optional<double> excess = excess_of(steps_->change());
  const bool is_large = excess && *excess >= 0.0;
  if (is_large && (!candidate_ || *excess > candidate_->excess)) {
    const bool is_told = candidate_ && candidate_->is_told;
    const Stamp middle = before.stamp + (steps_->after().stamp - before.stamp) / 2;
    candidate_ = Candidate{*excess, middle, energy_, kNoEnergy, 0, is_told};
  } else if (candidate_) {
    ++candidate_->age;
    candidate_->energy_after = std::max(candidate_->energy_after, before.energy);
  }

  Finding finding = Finding::kNothing;
  if (candidate_ && !candidate_->is_told && (!is_large || candidate_->age >= steps_->half())) {
    candidate_->is_told = true;
    samples_ago_ = steps_->half() + candidate_->age;
    if (counts(candidate_->stamp, candidate_->energy_before)) {
      finding = found(candidate_->stamp, candidate_->energy_after);
    }
  }
  if (!is_large) candidate_.reset();
  return finding;
}

bool JumpDetector::counts(Stamp jump, double energy) const {
  const bool is_too_soon = crossing_ > 0 && jump - crossing_ < options_.refractory;
  return !is_too_soon && energy >= options_.least_energy;
}

JumpDetector::Finding JumpDetector::found(Stamp jump, double energy_since) {
  crossing_ = jump;
  since_ = jump;
  energy_ = energy_since;
  return Finding::kJump;
}

void JumpDetector::restart() {
  stamp_ = 0;
  height_ = 0.0;
  is_armed_ = false;
  crossing_ = 0;
  samples_ago_ = 0;
  since_ = 0;
  energy_ = kNoEnergy;
  if (scale_) scale_->clear();
  if (steps_) steps_->clear();
  candidate_.reset();
}

}  // namespace sampled_data_observers
