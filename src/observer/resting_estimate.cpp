#include "observer/resting_estimate.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

void require_of_rest(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(std::string("RestingEstimate: ") + what);
}

}  // namespace

RestingEstimate::RestingEstimate(const std::shared_ptr<const ObserverLaw>& inner, RestState rest)
    : LawDecorator(inner), rest_(std::move(rest)) {
  require_of_rest(rest_.set.fits(observer().plant().modes().size()),
                  "one margin for each formula of the set");
  require_of_rest(rest_.state->size() == estimate_size(), "one value for each state");
  require_of_rest(observer().plant().outputs(SensorTiming::kContinuous) == 0,
                  "no continuous outputs, which move the estimate all the time");
  set_at_rest(is_at_rest_);
}

void RestingEstimate::initialize(double* state) const {
  law().initialize(state);
  is_at_rest_.set(false, state);
}

void RestingEstimate::flow(Duration duration, double* state, double* workspace) const {
  if (is_at_rest_.of(state)) {
    advance_timers(duration, state);
  } else {
    law().flow(duration, state, workspace);
  }
}

Effect RestingEstimate::reset(const Event& event, double* state, double* workspace) const {
  const bool was_at_rest = is_at_rest_.of(state);
  if (was_at_rest) before_.set(state, workspace);
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) return effect;
  // With delayed jumps, x̂ jumps when they are released.
  const bool jumps = event.kind == (delays_jumps() ? EventKind::kRelease : EventKind::kJump);
  if (!was_at_rest && !jumps) return effect;
  is_at_rest_.set(is_in_set(state, workspace), state);
  if (!is_at_rest_.of(state)) return effect;
  const bool is_measured = event.kind == EventKind::kSample;
  if (jumps || event.kind == EventKind::kJumpOutput) {
    lie_down(state, workspace);
  } else if (is_measured) {
    // It says that the plant is at rest, which is known.
    std::copy_n(before_.of(workspace), before_.size(), state);
  }
  return effect;
}

bool RestingEstimate::is_in_set(const double* state, double* workspace) const {
  return rest_.set.contains(observer().mode_of(state), state, observer().held_part(state),
                            values_.of(workspace));
}

void RestingEstimate::lie_down(double* state, double* workspace) const {
  rest_.state->evaluate(state, observer().held_part(state), x_.of(workspace));
  observer().start_from(x_.of(workspace), state);
}

}  // namespace sampled_data_observers
