#include "observer/limited_jumps.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sampled_data_observers {

LimitedJumps::LimitedJumps(std::shared_ptr<const ObserverLaw> law, const JumpLimits& limits)
    : LawDecorator(std::move(law)), limits_(limits) {
  if (limits_.min_separation < 0) {
    throw std::invalid_argument("LimitedJumps: min_separation must not be negative");
  }
  if (!(limits_.max_per_second >= 1.0)) {
    throw std::invalid_argument("LimitedJumps: max_per_second must be at least 1");
  }
}

void LimitedJumps::initialize(double* state) const {
  law().initialize(state);
  since_.expire(state);
  tokens_.set(limits_.max_per_second, state);
}

void LimitedJumps::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  since_.advance(duration, state);
}

Effect LimitedJumps::reset(const Event& event, double* state, double* workspace) const {
  if (event.kind != EventKind::kJump) return law().reset(event, state, workspace);
  const double since = since_.of(state);
  if (since < static_cast<double>(limits_.min_separation)) return Effect::kRefused;
  // Filled up at jumps only, so that the number depends on the jumps alone.
  const double tokens =
      std::min(limits_.max_per_second, tokens_.of(state) + since * 1e-9 * limits_.max_per_second);
  if (tokens < 1.0) return Effect::kRefused;
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) return effect;
  tokens_.set(tokens - 1.0, state);
  since_.restart(state);
  return effect;
}

}  // namespace sampled_data_observers
