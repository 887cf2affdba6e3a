#include "observer/gated_samples.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace sampled_data_observers {
namespace {

// The decorator's own numbers, one per sensor: the time since the first of the samples rejected one
// after another [ns], counted up to recover_after, where the gate recovers; or one of these.
constexpr double kOpen = -2.0;    // nothing was inside since the start
constexpr double kClosed = -1.0;  // the last sample was inside

// Up to here, a sum of nanoseconds is exact, however the time is divided.
constexpr Duration kLongestRecovery = Duration{1} << 53;

Eigen::Index own_size(const std::vector<std::optional<Gate>>& gates) {
  return static_cast<Eigen::Index>(gates.size());
}

void refuse_unless(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(std::string("GatedSamples: ") + what);
}

bool has_covariance(const ObserverLaw& law) {
  Eigen::VectorXd state(law.state_size());
  law.initialize(state.data());
  return law.covariance(state.data()) != nullptr;
}

}  // namespace

GatedSamples::GatedSamples(const std::shared_ptr<const ObserverLaw>& inner,
                           std::vector<std::optional<Gate>> gates)
    : LawDecorator(inner, own_size(gates)), gates_(std::move(gates)) {
  refuse_unless(gates_.size() == inner->sensors(), "one gate, or nothing, per sensor");
  for (std::size_t i = 0; i < gates_.size(); ++i) {
    if (!gates_[i]) continue;
    const Gate& gate = *gates_[i];
    const Eigen::Index outputs = inner->event_size(EventKind::kSample, static_cast<int>(i));
    refuse_unless(outputs >= 0, "a gate takes a sensor that is sampled");
    refuse_unless(gate.recover_after > 0 && gate.recover_after < kLongestRecovery,
                  "recover_after must be positive, and less than 104 days");
    if (gate.innovation.size() > 0) {
      refuse_unless(gate.innovation.size() == outputs && gate.innovation.minCoeff() > 0.0,
                    "one positive limit per output");
    } else {
      refuse_unless(gate.mahalanobis > 0.0, "a limit must be positive");
      refuse_unless(has_covariance(*inner), "a Mahalanobis distance takes a law with a covariance");
    }
  }
}

/// For a state beside the law's own.
Eigen::Index GatedSamples::workspace_size() const {
  return law().workspace_size() + std::max(inner_size(), law().max_event_size());
}

void GatedSamples::initialize(double* state) const {
  law().initialize(state);
  std::fill_n(own(state), own_size(gates_), kOpen);
}

void GatedSamples::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  double* since = own(state);
  for (const std::optional<Gate>& gate : gates_) {
    if (gate && *since >= 0.0) {
      *since = std::min(static_cast<double>(gate->recover_after),
                        *since + static_cast<double>(duration));
    }
    ++since;
  }
}

Effect GatedSamples::reset(const Event& event, double* state, double* workspace) const {
  if (event.kind != EventKind::kSample || !gates_[static_cast<std::size_t>(event.channel)]) {
    return law().reset(event, state, workspace);
  }
  const Gate& gate = *gates_[static_cast<std::size_t>(event.channel)];
  double& since = own(state)[event.channel];
  if (!is_outside(event, state, workspace)) {
    since = kClosed;
    return law().reset(event, state, workspace);
  }
  if (since == kOpen) return law().reset(event, state, workspace);
  if (since == kClosed) since = 0.0;
  if (since < static_cast<double>(gate.recover_after)) return Effect::kGated;
  const bool anew = gate.recovery == Gate::Recovery::kReset;
  if (anew) begin_anew(state, workspace);
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) return effect;
  return anew ? Effect::kRestarted : Effect::kPastGate;
}

bool GatedSamples::is_outside(const Event& sample, const double* state, double* workspace) const {
  const Gate& gate = *gates_[static_cast<std::size_t>(sample.channel)];
  if (gate.innovation.size() == 0) {
    return law().mahalanobis_distance(sample, state, workspace) > gate.mahalanobis;
  }
  double* innovation = workspace + law().workspace_size();
  law().innovation(sample, state, innovation);
  for (Eigen::Index i = 0; i < sample.size; ++i) {
    if (std::abs(innovation[i]) > gate.innovation(i)) return true;
  }
  return false;
}

void GatedSamples::begin_anew(double* state, double* workspace) const {
  double* before = workspace + law().workspace_size();
  std::copy_n(state, inner_size(), before);
  initialize(state);
  law().keep_held(law().held_part(before), state);
  law().keep_mode(law().mode_of(before), state);
  // Nobody vouches for this start.
  law().hold(state);
}

}  // namespace sampled_data_observers
