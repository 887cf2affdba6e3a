#include "sampled_data_observers/certificate/guaranteed_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sampled_data_observers {
namespace {

// The decorator's own numbers: the time since the last sample, jump or start [ns], whether the
// outputs of the last jump are still to come, and two parts: the bound then (before a jump whose
// outputs are still to come), and the bound now, which is always computed from that one, however
// often the flow is interrupted.
constexpr Eigen::Index kSince = 0;
constexpr Eigen::Index kAwaiting = 1;
constexpr Eigen::Index kParts = 2;

// A part: why the bound is lost (BoundLoss), 0 where it is not, and the state of the ErrorBound.
// Infinity itself would make the whole state unusable to the timeline, as would numbers beyond its
// limit.
constexpr Eigen::Index kLost = 0;
constexpr Eigen::Index kState = 1;
constexpr double kLargest = 1e100;

/// Of |x̂| and each state: rounding of the estimate.
constexpr double kFloor = 64.0 * std::numeric_limits<double>::epsilon();

}  // namespace

GuaranteedBound::GuaranteedBound(const std::shared_ptr<const ObserverLaw>& inner,
                                 std::unique_ptr<const ErrorBound> bound, double error_limit)
    : LawDecorator(inner, kParts + 2 * (kState + bound->state_size())),
      bound_(std::move(bound)),
      error_limit_(error_limit),
      jumps_are_measured_(inner->event_size(EventKind::kJump, kMeasuredJump) >= 0) {}

Eigen::Index GuaranteedBound::workspace_size() const {
  return std::max(law().workspace_size(), bound_->workspace_size());
}

double* GuaranteedBound::then(double* state) const { return own(state) + kParts; }

double* GuaranteedBound::now(double* state) const {
  return then(state) + kState + bound_->state_size();
}

const double* GuaranteedBound::now(const double* state) const {
  return own(state) + kParts + kState + bound_->state_size();
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

void GuaranteedBound::settle(double* part, BoundLoss reason) const {
  const auto is_moderate = [](double value) { return std::abs(value) <= kLargest; };
  const double* first = part;
  const double* last = first + kState + bound_->state_size();
  if (!is_moderate(bound_of(part)) || !std::all_of(first, last, is_moderate)) lose(part, reason);
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
  own(state)[kSince] = 0.0;
  own(state)[kAwaiting] = 0.0;
  then(state)[kLost] = 0.0;
  bound_->initialize(then(state) + kState);
  settle(then(state), BoundLoss::kTooLarge);
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
    bound_->uncorrected_jump(part + kState);
    settle(part, BoundLoss::kJumpTimes);
  }
  if (part[kLost] != 0.0 || numbers[kSince] == 0.0) return;
  bound_->flow(numbers[kSince] / static_cast<double>(kNanosecondsPerSecond), part + kState);
  settle(part, BoundLoss::kTooLarge);
}

Effect GuaranteedBound::reset(const Event& event, double* state, double* workspace) const {
  if (event.kind == EventKind::kRejected) {
    const bool is_input = event.channel == static_cast<int>(EventKind::kInput);
    give_up(state, is_input ? BoundLoss::kUnknownInput : BoundLoss::kUnknownJump);
    return Effect::kApplied;
  }
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) {
    if (event.kind == EventKind::kJump) give_up(state, BoundLoss::kRefusedJump);
    return effect;
  }
  const bool is_jump = event.kind == EventKind::kJump;
  const bool comes_to_jump = event.kind == EventKind::kJumpOutput && own(state)[kAwaiting] != 0.0 &&
                             own(state)[kSince] == 0.0;
  if (event.kind == EventKind::kSample || is_jump) begin_interval(state);
  double* part = then(state);
  if (event.kind == EventKind::kSample) {
    bound_->sample(part + kState, workspace);
    settle(part, BoundLoss::kTooLarge);
  } else if (is_jump && jumps_are_measured_ && event.channel == kPlainJump) {
    // The part stays as before the jump, to which the outputs of the same stamp belong.
    own(state)[kAwaiting] = 1.0;
    flow_part(state);
    return effect;
  } else if (is_jump || comes_to_jump) {
    own(state)[kAwaiting] = 0.0;
    bound_->jump(part + kState);
    settle(part, BoundLoss::kJumpTimes);
  } else {
    return effect;
  }
  take_over(part, now(state));
  return effect;
}

void GuaranteedBound::begin_interval(double* state) const {
  double* part = then(state);
  take_over(now(state), part);
  own(state)[kSince] = 0.0;
  own(state)[kAwaiting] = 0.0;
  if (bound_of(part) > error_limit_) lose(part, BoundLoss::kAngle);
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

BoundLoss GuaranteedBound::bound_loss(const double* state) const {
  return static_cast<BoundLoss>(static_cast<int>(now(state)[kLost]));
}

}  // namespace sampled_data_observers
