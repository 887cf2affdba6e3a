#include "certificate/guaranteed_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sampled_data_observers {
namespace {

// The decorator's own numbers: the time since the last sample, jump or start [ns], whether the
// outputs of the last jump are still to come, and how far x̂ moved at it; x̂ before the last sample
// or jump; and two parts: the bound then (before a jump whose outputs are still to come), and the
// bound now, which is always computed from that one, however often the flow is interrupted.
constexpr Eigen::Index kSince = 0;
constexpr Eigen::Index kAwaiting = 1;
constexpr Eigen::Index kMoved = 2;
constexpr Eigen::Index kBefore = 3;

// A part: why the bound is lost (BoundLoss), 0 where it is not, and the state of the ErrorBound.
// Infinity itself would make the whole state unusable to the timeline, as would numbers beyond its
// limit.
constexpr Eigen::Index kLost = 0;
constexpr Eigen::Index kState = 1;
constexpr double kLargest = 1e100;

/// Of |x̂| and each state: rounding of the estimate.
constexpr double kFloor = 64.0 * std::numeric_limits<double>::epsilon();

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
    : LawDecorator(inner, kBefore + inner->estimate_size() + 2 * (kState + bound->state_size())),
      bound_(std::move(bound)),
      plant_(std::move(plant)),
      noise_(noise),
      angles_(weights_of_angles(*plant_)),
      jumps_are_measured_(inner->event_size(EventKind::kJump, kMeasuredJump) >= 0) {}

Eigen::Index GuaranteedBound::workspace_size() const {
  return std::max({law().workspace_size(), bound_->workspace_size(), law().max_event_size()});
}

double* GuaranteedBound::before(double* state) const { return own(state) + kBefore; }

double* GuaranteedBound::then(double* state) const {
  return own(state) + kBefore + law().estimate_size();
}

double* GuaranteedBound::now(double* state) const {
  return then(state) + kState + bound_->state_size();
}

const double* GuaranteedBound::now(const double* state) const {
  return own(state) + kBefore + law().estimate_size() + kState + bound_->state_size();
}

double GuaranteedBound::bound_of(const double* part) const {
  if (part[kLost] != 0.0) return std::numeric_limits<double>::infinity();
  return bound_->bound(part + kState);
}

void GuaranteedBound::lose(double* part, BoundLoss reason) const {
  if (part[kLost] != 0.0) return;
  part[kLost] = static_cast<double>(reason);
  std::fill_n(part + kState, bound_->state_size(), 0.0);
}

void GuaranteedBound::settle(double* part) const {
  const auto is_moderate = [](double value) { return std::abs(value) <= kLargest; };
  const double* first = part;
  const double* last = first + kState + bound_->state_size();
  if (!is_moderate(bound_of(part)) || !std::all_of(first, last, is_moderate)) {
    lose(part, BoundLoss::kTooLarge);
  }
}

void GuaranteedBound::give_up(double* state, BoundLoss reason) const {
  lose(then(state), reason);
  lose(now(state), reason);
}

void GuaranteedBound::take_over(const double* from, double* to) const {
  std::copy_n(from, kState + bound_->state_size(), to);
}

void GuaranteedBound::initialize(double* state) const {
  law().initialize(state);
  std::fill_n(own(state), kBefore + law().estimate_size(), 0.0);
  then(state)[kLost] = 0.0;
  bound_->initialize(then(state) + kState);
  settle(then(state));
  take_over(then(state), now(state));
}

Eigen::Index GuaranteedBound::event_size(EventKind kind, int channel) const {
  if (kind != EventKind::kRejected) return law().event_size(kind, channel);
  const bool matters = channel == static_cast<int>(EventKind::kInput) ||
                       channel == static_cast<int>(EventKind::kJump);
  return matters ? 0 : -1;
}

void GuaranteedBound::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  own(state)[kSince] += static_cast<double>(duration);
  flow_part(state);
}

/// Sets the bound now from the one at the last sample, jump or start.
void GuaranteedBound::flow_part(double* state) const {
  const double* numbers = own(state);
  double* part = now(state);
  take_over(then(state), part);
  if (part[kLost] != 0.0) return;
  if (numbers[kAwaiting] != 0.0) {
    bound_->uncorrected_jump(numbers[kMoved], part + kState);
    settle(part);
  }
  if (part[kLost] != 0.0 || numbers[kSince] == 0.0) return;
  bound_->flow(numbers[kSince] / static_cast<double>(kNanosecondsPerSecond), part + kState);
  settle(part);
}

Effect GuaranteedBound::reset(const Event& event, double* state, double* workspace) const {
  const bool is_jump = event.kind == EventKind::kJump;
  const bool is_output = event.kind == EventKind::kJumpOutput;
  const bool comes_to_jump = is_output && own(state)[kAwaiting] != 0.0 && own(state)[kSince] == 0.0;
  if (event.kind == EventKind::kRejected) {
    const bool is_input = event.channel == static_cast<int>(EventKind::kInput);
    give_up(state, is_input ? BoundLoss::kUnknownInput : BoundLoss::kUnknownJump);
    return Effect::kApplied;
  }
  const bool is_sample = event.kind == EventKind::kSample;
  const bool is_wrapped = is_sample && may_be_wrapped(event, state, workspace);
  if ((is_sample || is_jump || is_output) && !comes_to_jump) {
    std::copy_n(state, law().estimate_size(), before(state));
  }
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) {
    if (is_jump) refuse_jump(state);
    return effect;
  }
  if (is_sample) {
    begin_interval(state);
    sample(state, workspace, is_wrapped);
  } else if (is_jump) {
    begin_interval(state);
    jump(event, state);
  } else if (comes_to_jump) {
    take_jump(state);
  } else if (is_output && moved_since_before(state) > 0.0) {
    go_on_from_moved(state);
  }
  return effect;
}

void GuaranteedBound::sample(double* state, double* workspace, bool is_wrapped) const {
  double* part = then(state);
  if (!is_wrapped) {
    bound_->sample(part + kState, workspace);
  } else if (bound_->injects_between_samples()) {
    lose(part, BoundLoss::kAngle);
  } else {
    go_on_from_moved(state);
    return;
  }
  settle(part);
  take_over(part, now(state));
}

/// x stayed, and x̂ moved by what is known.
void GuaranteedBound::go_on_from_moved(double* state) const {
  begin_interval(state);
  double* part = then(state);
  const double error = bound_of(part) + moved_since_before(state);
  if (std::isfinite(error)) bound_->begin(error, part + kState);
  settle(part);
  take_over(part, now(state));
}

void GuaranteedBound::jump(const Event& event, double* state) const {
  if (!jumps_are_measured_ || event.channel != kPlainJump) {
    take_jump(state);
    return;
  }
  // The part stays as before the jump, to which the outputs of the same stamp belong.
  own(state)[kAwaiting] = 1.0;
  own(state)[kMoved] = moved_since_before(state);
  flow_part(state);
}

/// A jump with its outputs, where it has any.
void GuaranteedBound::take_jump(double* state) const {
  own(state)[kAwaiting] = 0.0;
  double* part = then(state);
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    if (plant_->sensors()[i].timing != SensorTiming::kAtJumps) continue;
    if (may_be_wrapped(bound_of(part), i, nullptr)) lose(part, BoundLoss::kAngle);
  }
  bound_->jump(moved_since_before(state), part + kState);
  settle(part);
  take_over(part, now(state));
}

/// Nobody knows whether the plant has jumped.
void GuaranteedBound::refuse_jump(double* state) const {
  begin_interval(state);
  const VectorMap* map = plant_->modes()[static_cast<std::size_t>(law().mode_of(state))].jump.get();
  if (map != nullptr) map->evaluate(state, law().held_part(state), before(state));
  double* part = then(state);
  bound_->refused_jump(moved_since_before(state), part + kState);
  settle(part);
  take_over(part, now(state));
}

void GuaranteedBound::begin_interval(double* state) const {
  take_over(now(state), then(state));
  own(state)[kSince] = 0.0;
  own(state)[kAwaiting] = 0.0;
}

double GuaranteedBound::moved_since_before(double* state) const {
  const double* from = before(state);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < law().estimate_size(); ++i) {
    sum += (state[i] - from[i]) * (state[i] - from[i]);
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
  const auto sensor = static_cast<std::size_t>(sample.channel);
  if (angles_[sensor].isZero(0.0)) return false;
  law().innovation(sample, state, workspace);
  return may_be_wrapped(bound_of(now(state)), sensor, workspace);
}

void GuaranteedBound::hold(double* state) const {
  law().hold(state);
  give_up(state, BoundLoss::kNotVouched);
}

double GuaranteedBound::error_bound(const double* state) const {
  if (bound_loss(state) != BoundLoss::kNone) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < law().estimate_size(); ++i) sum += state[i] * state[i];
  return bound_of(now(state)) +
         kFloor * static_cast<double>(law().estimate_size()) * std::sqrt(sum);
}

void GuaranteedBound::keep_bound(const PublishedBound& known, double* state) const {
  if (std::isfinite(known.value)) {
    bound_->begin(known.value, then(state) + kState);
    settle(then(state));
    take_over(then(state), now(state));
  } else {
    give_up(state, known.loss == BoundLoss::kNone ? BoundLoss::kNotVouched : known.loss);
  }
}

BoundLoss GuaranteedBound::bound_loss(const double* state) const {
  return static_cast<BoundLoss>(static_cast<int>(now(state)[kLost]));
}

}  // namespace sampled_data_observers
