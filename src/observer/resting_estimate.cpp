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
  const bool is_output = event.kind == EventKind::kJumpOutput;
  if (was_at_rest || is_output) before_.set(state, workspace);
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) return effect;
  // With delayed jumps, x̂ jumps when they are released.
  const bool jumps = event.kind == (delays_jumps() ? EventKind::kRelease : EventKind::kJump);
  // What was measured at the jump of this stamp makes it anew; without such a jump it moves
  // nothing.
  const bool completes_jump = is_output && !delays_jumps() &&
                              !std::equal(state, state + estimate_size(), before_.of(workspace));
  if (!was_at_rest && !jumps && !completes_jump) return effect;
  is_at_rest_.set(is_in_set(state, workspace), state);
  if (!is_at_rest_.of(state)) return effect;
  if (jumps || is_output) {
    lie_down(state, workspace);
  } else if (event.kind == EventKind::kSample) {
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
