#include "observer/delayed_jumps.h"

#include <algorithm>

namespace sampled_data_observers {
namespace {

// The decorator's own numbers: whether a reset is pending, the time since its jump [ns], and μ.
constexpr Eigen::Index kPending = 0;
constexpr Eigen::Index kSinceJump = 1;
constexpr Eigen::Index kMu = 2;

}  // namespace

DelayedJumps::DelayedJumps(const std::shared_ptr<const ObserverLaw>& inner)
    : LawDecorator(inner, kMu + inner->state_size()) {}

Eigen::Index DelayedJumps::event_size(EventKind kind, int channel) const {
  if (kind == EventKind::kRelease) return channel == 0 ? 1 : -1;
  return law().event_size(kind, channel);
}

Eigen::Index DelayedJumps::max_event_size() const {
  return std::max<Eigen::Index>(1, law().max_event_size());
}

void DelayedJumps::initialize(double* state) const {
  law().initialize(state);
  std::fill_n(own(state), kMu, 0.0);
  std::copy_n(state, inner_size(), own(state) + kMu);
}

void DelayedJumps::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  own(state)[kSinceJump] += static_cast<double>(duration);
}

Effect DelayedJumps::reset(const Event& event, double* state, double* workspace) const {
  double* numbers = own(state);
  double* mu = numbers + kMu;
  const bool pending = numbers[kPending] != 0.0;
  if (event.kind == EventKind::kRelease) {
    if (!pending || numbers[kSinceJump] != event.values[0]) {
      return Effect::kRefused;
    }
    release(state);
    return Effect::kApplied;
  }
  if (event.kind == EventKind::kJump) {
    if (pending) release(state);
    std::copy_n(state, inner_size(), mu);
    numbers[kSinceJump] = 0.0;
    numbers[kPending] = 1.0;
    return law().reset(event, mu, workspace);
  }
  // Of the jump's own stamp: its outputs, or a sample of the state after it.
  if (pending && numbers[kSinceJump] == 0.0) law().reset(event, mu, workspace);
  return law().reset(event, state, workspace);
}

/// z⁺ = μ, but for what is held.
void DelayedJumps::release(double* state) const {
  double* mu = own(state) + kMu;
  law().keep_held(law().held_part(state), mu);
  std::copy_n(mu, inner_size(), state);
  own(state)[kPending] = 0.0;
}

}  // namespace sampled_data_observers
