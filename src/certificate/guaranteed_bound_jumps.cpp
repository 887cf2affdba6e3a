// What a guaranteed bound does at jumps of the plant, and while the reset of one waits.
#include <cmath>
#include <optional>

#include "certificate/guaranteed_bound.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

double norm_of(const double* vector, Eigen::Index size) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) sum += vector[i] * vector[i];
  return std::sqrt(sum);
}

}  // namespace

void GuaranteedBound::await_outputs(double* state) const {
  // The part stays as before the jump, to which the outputs of the same stamp belong.
  awaiting_.set(true, state);
  moved_.set(moved_since_before(state), state);
  flow_part(state);
}

/// A jump with its outputs, where it has any.
void GuaranteedBound::take_jump(double* state) const {
  awaiting_.set(false, state);
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    if (plant_->sensors()[i].timing != SensorTiming::kAtJumps) continue;
    if (may_be_wrapped(bound_of(then_, state), i, nullptr)) lose(then_, BoundLoss::kAngle, state);
  }
  bound_->jump(motion(moved_since_before(state), state), then_.bound.of(state));
  go_on_from_then(state);
}

/// Whether its number, and its mode, are those of the jump before: then the plant made no other.
bool GuaranteedBound::is_told_again(const Event& jump, Effect effect, const double* state) const {
  if (effect != Effect::kRepeated) return false;
  const double mode = plant_->modes()[observer().mode_of(state)].label;
  return !plant_->switches() || jump.mode.value_or(mode) == mode;
}

/// Nobody knows whether the plant has jumped.
void GuaranteedBound::refuse_jump(double* state) const {
  begin_interval(state);
  if (plant_->switches()) {
    // It may be in another mode than the law.
    give_up(state, BoundLoss::kUnknownJump);
    return;
  }
  const VectorMap* map = plant_->modes()[observer().mode_of(state)].jump.get();
  if (map != nullptr) map->evaluate(state, observer().held_part(state), before_.of(state));
  bound_->refused_jump(motion(moved_since_before(state), state), then_.bound.of(state));
  go_on_from_then(state);
}

/// What the bound needs of a jump that may not have been at its stamp; x̂ before it stands in
/// before_. Of two of one stamp, numbers alone tell which was first.
void GuaranteedBound::note_stamp_of_jump(const Event& jump, double* state,
                                         double* workspace) const {
  const double since = since_jump_.of(state);
  const bool are_numbered = is_numbered_.of(state) && jump.index != 0;
  since_jump_.restart(state);
  is_numbered_.set(jump.index != 0, state);
  if (lets_jumps_coincide() && since == 0.0 && !are_numbered) {
    give_up(state, BoundLoss::kUncertainJump);
  }
  if (jump_stamp_error_ == 0) return;
  if (!shift_is_bounded_ || since <= 2.0 * static_cast<double>(jump_stamp_error_)) {
    give_up(state, BoundLoss::kUncertainJump);
    return;
  }
  const PlantMode& mode = plant_->modes().front();
  const double* u = observer().held_part(state);
  const double* x = before_.of(state);
  double* speed = speed_.of(workspace);
  mode.flow->evaluate(x, u, speed);
  speed_before_.set(norm_of(speed, estimate_size()), state);
  double* jumped = jumped_.of(workspace);
  mode.jump->evaluate(x, u, jumped);
  mode.flow->evaluate(jumped, u, speed);
  speed_after_.set(norm_of(speed, estimate_size()), state);
}

JumpMotion GuaranteedBound::motion(double moved, const double* state) const {
  JumpMotion motion{moved, speed_before_.of(state), speed_after_.of(state), law().told_mode(state)};
  if (law().awaited(state) != nullptr) motion.awaited_speed = awaited_speed_.of(state);
  return motion;
}

/// x̂, or, while a jump waits, what it leads to.
const double* GuaranteedBound::next_estimate(const double* state) const {
  const double* next = law().awaited(state);
  return next != nullptr ? next : state;
}

void GuaranteedBound::note_awaited_speed(double* state, double* workspace) const {
  const double* next = law().awaited(state);
  if (next == nullptr) return;
  double* speed = speed_.of(workspace);
  const PlantMode& mode = plant_->modes()[law().told_mode(state)];
  mode.flow->evaluate(next, observer().held_part(state), speed);
  awaited_speed_.set(norm_of(speed, estimate_size()), state);
}

void GuaranteedBound::release(double* state) const {
  begin_interval(state);
  bound_->release(then_.bound.of(state));
  go_on_from_then(state);
}

}  // namespace sampled_data_observers
