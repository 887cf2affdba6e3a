#include "certificate/guaranteed_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

/// Infinity itself would make the whole state unusable to the timeline, as would numbers beyond its
/// limit.
constexpr double kLargest = 1e100;

constexpr double kPi = 3.14159265358979323846;
/// For the rounding of an innovation [rad].
constexpr double kAngleMargin = 1e-9;

/// |C_i| of each angular output of each sensor; 0 of others.
std::vector<Eigen::VectorXd> weights_of_angles(const Plant& plant) {
  std::vector<Eigen::VectorXd> weights;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    Eigen::VectorXd& of_sensor = weights.emplace_back(Eigen::VectorXd::Zero(sensor.outputs()));
    for (Eigen::Index output = 0; output < sensor.outputs(); ++output) {
      if (!sensor.angular[static_cast<std::size_t>(output)]) continue;
      for (const PlantMode& mode : plant.modes()) {
        const AffineMap* map = mode.outputs[i]->affine();
        const double weight =
            map != nullptr ? map->M().row(output).norm() : std::numeric_limits<double>::infinity();
        of_sensor(output) = std::max(of_sensor(output), weight);
      }
    }
  }
  return weights;
}

}  // namespace

GuaranteedBound::GuaranteedBound(const std::shared_ptr<const ObserverLaw>& inner,
                                 std::unique_ptr<const ErrorBound> bound,
                                 std::shared_ptr<const Plant> plant, double noise)
    : LawDecorator(inner),
      bound_(std::move(bound)),
      plant_(std::move(plant)),
      noise_(noise),
      angles_(weights_of_angles(*plant_)),
      jumps_are_measured_(observer().event_size(EventKind::kJump) > 0),
      jump_stamp_error_(from_seconds(bound_->jump_stamp_error())),
      shift_is_bounded_(plant_->inputs() == 0 && !plant_->switches() &&
                        !plant_->has_angles(SensorTiming::kAtJumps)) {
  set_bound(this);
}

double GuaranteedBound::bound_of(const Part& part, const double* state) const {
  if (part.loss.of(state) != BoundLoss::kNone) return std::numeric_limits<double>::infinity();
  return bound_->bound(part.bound.of(state));
}

void GuaranteedBound::lose(const Part& part, BoundLoss reason, double* state) {
  if (part.loss.of(state) != BoundLoss::kNone) return;
  part.loss.set(reason, state);
  part.bound.fill(0.0, state);
}

void GuaranteedBound::copy(const Part& from, const Part& to, double* state) {
  to.loss.set(from.loss.of(state), state);
  to.bound.set(from.bound.of(state), state);
}

void GuaranteedBound::settle(const Part& part, double* state) const {
  const auto is_moderate = [](double value) { return std::abs(value) <= kLargest; };
  const double* numbers = part.bound.of(state);
  if (!is_moderate(bound_of(part, state)) ||
      !std::all_of(numbers, numbers + part.bound.size(), is_moderate)) {
    lose(part, BoundLoss::kTooLarge, state);
  }
}

void GuaranteedBound::lose(BoundLoss reason, double* state) const {
  lose(then_, reason, state);
  lose(now_, reason, state);
}

void GuaranteedBound::give_up(double* state, BoundLoss reason) const {
  lose(reason, state);
  // All but an input may be, or hide, a jump that the estimate lacks.
  if (plant_->switches() && reason != BoundLoss::kUnknownInput) mode_is_open_.set(true, state);
}

void GuaranteedBound::give_up(double* state) const { give_up(state, BoundLoss::kNotVouched); }

bool GuaranteedBound::mode_is_open(const double* state) const { return mode_is_open_.of(state); }

void GuaranteedBound::leave_mode_open(double* state) const {
  give_up(state, BoundLoss::kUnknownJump);
}

/// The bound at the last sample, jump or start is also the one now.
void GuaranteedBound::go_on_from_then(double* state) const {
  settle(then_, state);
  copy(then_, now_, state);
}

void GuaranteedBound::initialize(double* state) const {
  law().initialize(state);
  since_.restart(state);
  awaiting_.set(false, state);
  mode_is_open_.set(false, state);
  is_numbered_.set(false, state);
  moved_.set(0.0, state);
  speed_before_.set(0.0, state);
  speed_after_.set(0.0, state);
  awaited_speed_.set(0.0, state);
  since_start_.restart(state);
  since_jump_.expire(state);
  before_.fill(0.0, state);
  then_.loss.set(BoundLoss::kNone, state);
  bound_->initialize(then_.bound.of(state));
  go_on_from_then(state);
}

bool GuaranteedBound::accepts(const Event& event) const {
  if (event.kind != EventKind::kRejected) return law().accepts(event);
  return event.rejected == EventKind::kInput || event.rejected == EventKind::kJump;
}

void GuaranteedBound::flow(Duration duration, double* state, double* workspace) const {
  const double missing = law().missing_jumps(state);
  const double violations = law().dwell_violations(state);
  // No more outputs come to a jump that waits.
  if (duration > 0 && awaiting_.of(state) && law().awaited(state) != nullptr) begin_interval(state);
  look_at_law(state, workspace);
  law().flow(duration, state, workspace);
  if (law().missing_jumps(state) != missing) give_up(state);
  if (law().dwell_violations(state) != violations) give_up(state, BoundLoss::kDwellTimes);
  if (law().is_at_rest(state)) give_up(state, BoundLoss::kAtRest);
  if (observer().is_input_stale(state)) give_up(state, BoundLoss::kUnknownInput);
  since_.advance(duration, state);
  since_start_.advance(duration, state);
  since_jump_.advance(duration, state);
  flow_part(state);
}

/// Sets the bound now from the one at the last sample, jump or start.
void GuaranteedBound::flow_part(double* state) const {
  copy(then_, now_, state);
  if (now_.loss.of(state) != BoundLoss::kNone) return;
  double* bound = now_.bound.of(state);
  if (awaiting_.of(state)) {
    bound_->uncorrected_jump(motion(moved_.of(state), state), bound);
    settle(now_, state);
  }
  if (now_.loss.of(state) != BoundLoss::kNone || since_.of(state) == 0.0) return;
  bound_->flow(since_.of(state) / static_cast<double>(kNanosecondsPerSecond), bound);
  settle(now_, state);
}

Effect GuaranteedBound::reset(const Event& event, double* state, double* workspace) const {
  const bool is_jump = event.kind == EventKind::kJump;
  const bool is_output = event.kind == EventKind::kJumpOutput;
  const bool outputs_may_come = awaiting_.of(state) && since_.of(state) == 0.0;
  const bool comes_to_jump = is_output && outputs_may_come;
  if (event.kind == EventKind::kRejected) {
    if (law().accepts(event)) law().reset(event, state, workspace);
    const bool is_input = event.rejected == EventKind::kInput;
    give_up(state, is_input ? BoundLoss::kUnknownInput : BoundLoss::kUnknownJump);
    return Effect::kApplied;
  }
  look_at_law(state, workspace);
  const bool is_sample = event.kind == EventKind::kSample;
  const bool is_wrapped = is_sample && may_be_wrapped(event, state, workspace);
  if ((is_sample || is_jump || is_output) && !comes_to_jump) {
    before_.set(next_estimate(state), state);
  }
  const bool awaits = law().awaited(state) != nullptr;
  const double skipped = law().skipped_jumps(state);
  const double violations = law().dwell_violations(state);
  const Effect effect = law().reset(event, state, workspace);
  if (law().skipped_jumps(state) > skipped) give_up(state, BoundLoss::kUnknownJump);
  if (law().dwell_violations(state) != violations) give_up(state, BoundLoss::kDwellTimes);
  if (law().is_at_rest(state)) give_up(state, BoundLoss::kAtRest);
  // Outputs of the same stamp would find before_ overwritten.
  if (!outputs_may_come && is_told_again(event, effect, state)) return effect;
  if (is_jump && took_effect(effect) && awaits) release(state);
  note_awaited_speed(state, workspace);
  if (is_jump && event.mode && took_effect(effect)) mode_is_open_.set(false, state);
  if (is_jump) note_stamp_of_jump(event, state, workspace);
  if (!took_effect(effect)) {
    if (is_jump && awaits) give_up(state, BoundLoss::kUnknownJump);
    if (is_jump) refuse_jump(state);
    return effect;
  }
  if (is_sample) {
    begin_interval(state);
    sample(static_cast<std::size_t>(event.sensor), state, workspace, is_wrapped);
  } else if (is_jump) {
    begin_interval(state);
    const bool is_whole = effect != Effect::kWithoutOutputs;
    if (jumps_are_measured_ && (event.size == 0 || !is_whole)) {
      await_outputs(state);
    } else if (is_whole) {
      take_jump(state);
    } else {
      give_up(state);
    }
  } else if (comes_to_jump) {
    if (effect != Effect::kWithoutOutputs) take_jump(state);
  } else if (is_output && moved_since_before(state) > 0.0) {
    if (awaits) give_up(state, BoundLoss::kUnknownJump);
    go_on_from_moved(state);
  } else if (event.kind == EventKind::kOutput && bound_->holds_outputs()) {
    begin_interval(state);
    bound_->output(then_.bound.of(state));
    go_on_from_then(state);
  } else if (event.kind == EventKind::kRelease) {
    release(state);
  } else if (event.kind == EventKind::kInput && awaits) {
    begin_interval(state);
    bound_->change_awaited_speed(awaited_speed_.of(state), then_.bound.of(state));
    go_on_from_then(state);
  }
  return effect;
}

/// Where an interval begins: nothing flowed since.
void GuaranteedBound::look_at_law(double* state, double* workspace) const {
  if (!bound_->follows_law() || since_.of(state) != 0.0 || awaiting_.of(state)) return;
  if (then_.loss.of(state) != BoundLoss::kNone) return;
  bound_->look_at({observer().mode_of(state), observer().innovation_of_held(state, workspace)},
                  then_.bound.of(state));
  go_on_from_then(state);
}

void GuaranteedBound::sample(std::size_t sensor, double* state, double* workspace,
                             bool is_wrapped) const {
  double* bound = then_.bound.of(state);
  if (!is_wrapped) {
    bound_->sample(sensor, bound, bound_workspace_.of(workspace));
  } else if (bound_->injects_between_samples()) {
    lose(then_, BoundLoss::kAngle, state);
  } else {
    const double error = bound_of(then_, state) + moved_since_before(state);
    if (std::isfinite(error)) bound_->begin_at_sample(sensor, error, bound);
  }
  go_on_from_then(state);
}

/// x stayed, and x̂ moved by what is known.
void GuaranteedBound::go_on_from_moved(double* state) const {
  begin_interval(state);
  const double error = bound_of(then_, state) + moved_since_before(state);
  if (std::isfinite(error)) bound_->begin(error, then_.bound.of(state));
  go_on_from_then(state);
}

void GuaranteedBound::begin_interval(double* state) const {
  copy(now_, then_, state);
  since_.restart(state);
  awaiting_.set(false, state);
}

double GuaranteedBound::moved_since_before(const double* state) const {
  const double* from = before_.of(state);
  const double* to = next_estimate(state);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < estimate_size(); ++i) {
    sum += (to[i] - from[i]) * (to[i] - from[i]);
  }
  return std::sqrt(sum);
}

/// Whether an angle y_i − C_i x̂ and its innovation may differ by a turn or more.
/// @param innovation  wrapped; null where it is not known
bool GuaranteedBound::may_be_wrapped(double error, std::size_t sensor,
                                     const double* innovation) const {
  const Eigen::VectorXd& weights = angles_[sensor];
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (weights(i) == 0.0) continue;
    const double wrapped = innovation == nullptr ? kPi : std::abs(innovation[i]);
    if (weights(i) * error + noise_ + kAngleMargin >= 2.0 * kPi - wrapped) return true;
  }
  return false;
}

bool GuaranteedBound::may_be_wrapped(const Event& sample, double* state, double* workspace) const {
  const auto sensor = static_cast<std::size_t>(sample.sensor);
  if (angles_[sensor].isZero(0.0)) return false;
  double* innovation = innovation_.of(workspace);
  observer().innovation(sample, state, innovation);
  return may_be_wrapped(bound_of(now_, state), sensor, innovation);
}

}  // namespace sampled_data_observers
