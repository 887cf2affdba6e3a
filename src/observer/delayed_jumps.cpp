#include "observer/delayed_jumps.h"

#include <algorithm>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

DelayedJumps::DelayedJumps(const std::shared_ptr<const ObserverLaw>& inner) : LawDecorator(inner) {
  set_delays_jumps();
}

bool DelayedJumps::accepts(const Event& event) const {
  return event.kind == EventKind::kRelease || law().accepts(event);
}

void DelayedJumps::initialize(double* state) const {
  law().initialize(state);
  pending_.set(false, state);
  since_jump_.restart(state);
  index_.set(0.0, state);
  mode_.set(0.0, state);
  mu_.set(state, state);
}

void DelayedJumps::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  since_jump_.advance(duration, state);
}

Effect DelayedJumps::reset(const Event& event, double* state, double* workspace) const {
  const bool pending = pending_.of(state);
  if (event.kind == EventKind::kRelease) {
    if (!pending || !is_of_pending(event, state)) return Effect::kRefused;
    release(state);
    return Effect::kApplied;
  }
  if (event.kind == EventKind::kJump) {
    if (pending) release(state);
    mu_.set(state, state);
    since_jump_.restart(state);
    index_.set(static_cast<double>(event.index), state);
    mode_.set(event.mode.value_or(0.0), state);
    pending_.set(true, state);
    return law().reset(event, mu_.of(state), workspace);
  }
  const bool is_of_stamp = pending && since_jump_.of(state) == 0.0;
  if (event.kind == EventKind::kJumpOutput) {
    // z may be what a jump before left, as if that were just now: the outputs are not its.
    return is_of_stamp ? law().reset(event, mu_.of(state), workspace) : Effect::kApplied;
  }
  // A sample of the state after it, or what is held from then on.
  if (is_of_stamp) law().reset(event, mu_.of(state), workspace);
  return law().reset(event, state, workspace);
}

/// Several jumps may be told with one stamp: one of them in place of another that was withdrawn.
bool DelayedJumps::is_of_pending(const Event& release, const double* state) const {
  return since_jump_.of(state) == static_cast<double>(release.delay) &&
         index_.of(state) == static_cast<double>(release.index) &&
         mode_.of(state) == release.mode.value_or(0.0);
}

/// z⁺ = μ, but for what is held.
void DelayedJumps::release(double* state) const {
  double* mu = mu_.of(state);
  observer().keep_held(observer().held_part(state), mu);
  std::copy_n(mu, mu_.size(), state);
  pending_.set(false, state);
}

}  // namespace sampled_data_observers
