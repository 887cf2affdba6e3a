#include "observer/missing_jumps.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "sampled_data_observers/hybrid/split_flow.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

void require_for_watch(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(std::string("MissingJumpsWatch: ") + what);
}

StateSet with_margins_times(double factor, StateSet set) {
  set.margins *= factor;
  return set;
}

Event jump_without_outputs() {
  Event event;
  event.kind = EventKind::kJump;
  return event;
}

}  // namespace

MissingJumpsWatch::MissingJumpsWatch(const std::shared_ptr<const ObserverLaw>& inner,
                                     MissingJumps options)
    : LawDecorator(inner),
      options_(std::move(options)),
      flow_set_(with_margins_times(0.0, options_.flow_set)),
      inner_set_(with_margins_times(-1.0, options_.flow_set)) {
  require_for_watch(
      options_.flow_set.fits(observer().plant().modes().size()) &&
          options_.flow_set.margins.minCoeff() >= 0.0,
      "a flow set for each mode, and one margin, not negative, for each of its formulas");
  const Duration step = inner->flow_step();
  require_for_watch(options_.step > 0 && (step == 0 || options_.step % step == 0),
                    "the step must be positive, and so many steps of the flow");
  if (options_.action == MissingJumps::Action::kPredict) {
    require_for_watch(!inner->delays_jumps(), "jumps that are delayed can't be made up");
    require_for_watch(!observer().plant().switches(),
                      "a jump into an unknown mode can't be made up");
  }
  facts().flow_step = options_.step;
  facts().flow_horizon = std::min(facts().flow_horizon, observer().plant().integration().horizon);
  set_jump_watch(this);
}

void MissingJumpsWatch::initialize(double* state) const {
  law().initialize(state);
  double_.set(state, state);
  has_double_.set(false, state);
  since_double_.restart(state);
  flowed_.set(0.0, state);
  double_jumps_.set(0.0, state);
  is_noticed_.set(false, state);
  is_doubted_.set(false, state);
  missing_.set(0.0, state);
}

void MissingJumpsWatch::flow(Duration duration, double* state, double* workspace) const {
  forget_where_held(state);
  for (Duration left = duration; left > 0; left -= options_.step) {
    flow_step_of(std::min(left, options_.step), state, workspace);
  }
}

void MissingJumpsWatch::flow_step_of(Duration duration, double* state, double* workspace) const {
  if (has_double_.of(state)) flow_double(duration, state, workspace);
  before_.set(state, workspace);
  law().flow(duration, state, workspace);
  since_double_.advance(duration, state);
  if (is_doubted_.of(state)) return;
  if (law().is_at_rest(state) || is_inside(state, workspace)) {
    has_double_.set(false, state);
    is_noticed_.set(false, state);
    return;
  }
  const bool predicts = options_.action == MissingJumps::Action::kPredict;
  if (predicts && !has_double_.of(state) && leaves_further(state, workspace)) {
    has_double_.set(jump_where_it_left(duration, double_.of(state), workspace), state);
    since_double_.restart(state);
    flowed_.set(0.0, state);
    double_jumps_.set(1.0, state);
  }
  if (is_within_margin(state, workspace)) return;
  const bool is_made_up = has_double_.of(state);
  const double jumps = is_made_up ? double_jumps_.of(state) : 1.0;
  if (!is_noticed_.of(state)) missing_.set(missing_.of(state) + jumps, state);
  if (is_made_up) {
    std::copy_n(double_.of(state), double_.size(), state);
    has_double_.set(false, state);
  }
  is_noticed_.set(!is_made_up, state);
}

void MissingJumpsWatch::flow_double(Duration duration, double* state, double* workspace) const {
  double* twin = double_.of(state);
  before_.set(twin, workspace);
  law().flow(duration, twin, workspace);
  flowed_.set(flowed_.of(state) + static_cast<double>(duration), state);
  const bool jumps_on = law().can_rest() && !law().is_at_rest(twin) &&
                        !is_inside(twin, workspace) && leaves_further(twin, workspace);
  if (!jumps_on) return;
  if (jump_where_it_left(duration, twin, workspace)) {
    double_jumps_.set(double_jumps_.of(state) + 1.0, state);
  } else {
    has_double_.set(false, state);
  }
}

/// Whether the estimate was inside the flow set before the last step, or nearer to it. What comes
/// back, as a ball that bounced too late, must not jump once more.
bool MissingJumpsWatch::leaves_further(const double* state, double* workspace) const {
  const double* before = before_.of(workspace);
  double* values = values_.of(workspace);
  const double excess =
      flow_set_.excess(observer().mode_of(before), before, observer().held_part(before), values);
  return excess <= 0.0 || !(flow_set_.excess(observer().mode_of(state), state,
                                             observer().held_part(state), values) < excess);
}

/// Sets `jumped` to the state of before the last step, which jumps as soon as it is outside the
/// flow set, and goes on to the end of the step. Returns whether it could.
bool MissingJumpsWatch::jump_where_it_left(Duration duration, double* jumped,
                                           double* workspace) const {
  const Duration leaves_after = time_of_leaving(duration, jumped, workspace);
  const Effect effect = law().reset(jump_without_outputs(), jumped, workspace);
  law().flow(duration - leaves_after, jumped, workspace);
  return took_effect(effect) &&
         is_usable(Eigen::Map<const Eigen::VectorXd>(jumped, double_.size()));
}

/// When the estimate leaves the flow set in the last step, to a nanosecond; `trial` is the state
/// then.
Duration MissingJumpsWatch::time_of_leaving(Duration duration, double* trial,
                                            double* workspace) const {
  const auto go_to = [&](Duration time) {
    std::copy_n(before_.of(workspace), double_.size(), trial);
    if (time > 0) law().flow(time, trial, workspace);
  };
  go_to(0);
  if (!is_inside(trial, workspace)) return 0;
  Duration inside = 0;
  Duration outside = duration;
  while (outside - inside > 1) {
    const Duration middle = inside + (outside - inside) / 2;
    go_to(middle);
    (is_inside(trial, workspace) ? inside : outside) = middle;
  }
  go_to(outside);
  return outside;
}

Effect MissingJumpsWatch::reset(const Event& event, double* state, double* workspace) const {
  forget_where_held(state);
  const bool is_jump = event.kind == EventKind::kJump;
  const bool is_doubtful = is_jump && !is_near_edge(state, workspace);
  const Effect effect = law().reset(event, state, workspace);
  if (is_jump && took_effect(effect)) {
    has_double_.set(false, state);
    is_doubted_.set(is_doubtful, state);
  } else if (!is_jump && has_double_.of(state)) {
    law().reset(event, double_.of(state), workspace);
  }
  return effect;
}

void MissingJumpsWatch::forget_where_held(double* state) const {
  if (since_double_.of(state) != flowed_.of(state)) has_double_.set(false, state);
}

bool MissingJumpsWatch::is_inside(const double* state, double* workspace) const {
  return flow_set_.contains(observer().mode_of(state), state, observer().held_part(state),
                            values_.of(workspace));
}

bool MissingJumpsWatch::is_within_margin(const double* state, double* workspace) const {
  return options_.flow_set.contains(observer().mode_of(state), state, observer().held_part(state),
                                    values_.of(workspace));
}

bool MissingJumpsWatch::is_near_edge(const double* state, double* workspace) const {
  return is_within_margin(state, workspace) &&
         !inner_set_.contains(observer().mode_of(state), state, observer().held_part(state),
                              values_.of(workspace));
}

}  // namespace sampled_data_observers
