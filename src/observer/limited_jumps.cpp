#include "observer/limited_jumps.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sampled_data_observers {
namespace {

// The decorator's own numbers: the time since the last jump that took effect [ns], and how many may
// come at once now (a token bucket).
constexpr Eigen::Index kSince = 0;
constexpr Eigen::Index kTokens = 1;
constexpr Eigen::Index kOwnSize = 2;

constexpr double kLongAgo = 1e18;

}  // namespace

LimitedJumps::LimitedJumps(std::shared_ptr<const ObserverLaw> law, const JumpLimits& limits)
    : LawDecorator(std::move(law), kOwnSize), limits_(limits) {
  if (limits_.min_separation < 0) {
    throw std::invalid_argument("LimitedJumps: min_separation must not be negative");
  }
  if (!(limits_.max_per_second >= 1.0)) {
    throw std::invalid_argument("LimitedJumps: max_per_second must be at least 1");
  }
}

void LimitedJumps::initialize(double* state) const {
  law().initialize(state);
  own(state)[kSince] = kLongAgo;
  own(state)[kTokens] = limits_.max_per_second;
}

void LimitedJumps::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  double* numbers = own(state);
  numbers[kSince] = std::min(kLongAgo, numbers[kSince] + static_cast<double>(duration));
}

Effect LimitedJumps::reset(const Event& event, double* state, double* workspace) const {
  if (event.kind != EventKind::kJump) return law().reset(event, state, workspace);
  double* numbers = own(state);
  if (numbers[kSince] < static_cast<double>(limits_.min_separation)) return Effect::kRefused;
  // Filled up at jumps only, so that the number depends on the jumps alone.
  const double tokens = std::min(
      limits_.max_per_second, numbers[kTokens] + numbers[kSince] * 1e-9 * limits_.max_per_second);
  if (tokens < 1.0) return Effect::kRefused;
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) return effect;
  numbers[kTokens] = tokens - 1.0;
  numbers[kSince] = 0.0;
  return effect;
}

}  // namespace sampled_data_observers
