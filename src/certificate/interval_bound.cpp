#include "certificate/interval_bound.h"

#include <algorithm>
#include <limits>

namespace sampled_data_observers {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void IntervalBound::begin(double error, double* state) const {
  state[kTau] = 0.0;
  state[kHasEvent] = 0.0;
  begin_numbers(error, numbers(state));
}

void IntervalBound::flow(double duration, double* state) const {
  if (is_lost(state) || duration == 0.0) return;
  flow_numbers(duration, interval(state), numbers(state));
  state[kTau] += duration;
}

double IntervalBound::bound(const double* state) const {
  return is_lost(state) ? kInfinity : error(interval(state), numbers(state));
}

void IntervalBound::flow_numbers(double duration, const Interval& from, double* numbers) const {
  static_cast<void>(duration);
  static_cast<void>(from);
  static_cast<void>(numbers);
}

double IntervalBound::foreseen_part(double duration, double tau) const {
  return std::min(duration, std::max(0.0, T2_ - tau));
}

IntervalBound::Interval IntervalBound::interval(const double* state) {
  return {state[kTau], state[kHasEvent] == 0.0};
}

void IntervalBound::begin_interval(double* state) {
  state[kTau] = 0.0;
  state[kHasEvent] = 1.0;
}

bool IntervalBound::is_lost(const double* state) { return numbers(state)[0] == kInfinity; }

void IntervalBound::lose(double* state) { numbers(state)[0] = kInfinity; }

void SampledErrorBound::sample(std::size_t sensor, double* state, double* workspace) const {
  static_cast<void>(sensor);  // there is one
  if (is_lost(state)) return;
  sample_numbers(interval(state), numbers(state), workspace);
  begin_interval(state);
}

void SampledErrorBound::jump(const JumpMotion& motion, double* state) const {
  static_cast<void>(motion);
  lose(state);
}

}  // namespace sampled_data_observers
