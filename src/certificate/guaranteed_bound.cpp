#include "sampled_data_observers/certificate/guaranteed_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sampled_data_observers {
namespace {

// The decorator's own numbers: the time since the last sample, jump or start [ns], whether the
// outputs of the last jump are still to come, and two parts: the bound then, and the bound now,
// which is always computed from that one, however often the flow is interrupted.
constexpr Eigen::Index kSince = 0;
constexpr Eigen::Index kAwaiting = 1;
constexpr Eigen::Index kParts = 2;

// A part: whether the bound is lost, and the state of the ErrorBound. Infinity itself would make
// the whole state unusable to the timeline, as would numbers beyond its limit.
constexpr Eigen::Index kLost = 0;
constexpr Eigen::Index kState = 1;
constexpr double kLargest = 1e100;

void lose(double* part, Eigen::Index size) {
  part[kLost] = 1.0;
  std::fill_n(part + kState, size, 0.0);
}

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

void GuaranteedBound::settle(double* part) const {
  const Eigen::Index size = bound_->state_size();
  const auto is_moderate = [](double value) { return std::abs(value) <= kLargest; };
  if (is_moderate(bound_of(part)) && std::all_of(part, part + kState + size, is_moderate)) return;
  lose(part, size);
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
  settle(then(state));
  take_over(then(state), now(state));
}

void GuaranteedBound::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  double* numbers = own(state);
  numbers[kSince] += static_cast<double>(duration);
  double* part = now(state);
  take_over(then(state), part);
  if (numbers[kSince] == 0.0) return;
  if (numbers[kAwaiting] != 0.0) {
    lose(part, bound_->state_size());
  } else if (part[kLost] == 0.0) {
    bound_->flow(numbers[kSince] / static_cast<double>(kNanosecondsPerSecond), part + kState);
    settle(part);
  }
}

Effect GuaranteedBound::reset(const Event& event, double* state, double* workspace) const {
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) return effect;
  double& awaiting = own(state)[kAwaiting];
  const bool comes_to_jump =
      event.kind == EventKind::kJumpOutput && awaiting != 0.0 && own(state)[kSince] == 0.0;
  if (event.kind == EventKind::kSample) {
    begin_reset(state);
    bound_->sample(then(state) + kState, workspace);
    end_reset(state);
  } else if (event.kind == EventKind::kJump && jumps_are_measured_ && event.channel == kPlainJump) {
    begin_reset(state);
    awaiting = 1.0;
    end_reset(state);
  } else if (event.kind == EventKind::kJump || comes_to_jump) {
    begin_reset(state);
    awaiting = 0.0;
    bound_->jump(then(state) + kState);
    end_reset(state);
  }
  return effect;
}

void GuaranteedBound::begin_reset(double* state) const {
  double* part = then(state);
  take_over(now(state), part);
  own(state)[kSince] = 0.0;
  if (bound_of(part) > error_limit_) lose(part, bound_->state_size());
}

void GuaranteedBound::end_reset(double* state) const {
  settle(then(state));
  take_over(then(state), now(state));
}

void GuaranteedBound::hold(double* state) const {
  law().hold(state);
  lose(then(state), bound_->state_size());
  lose(now(state), bound_->state_size());
}

double GuaranteedBound::error_bound(const double* state) const {
  const bool awaits = own(state)[kAwaiting] != 0.0;
  return awaits ? std::numeric_limits<double>::infinity() : bound_of(now(state));
}

}  // namespace sampled_data_observers
