#include "observer/gated_samples.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

// Up to here, a sum of nanoseconds is exact, however the time is divided.
constexpr Duration kLongestRecovery = Duration{1} << 53;

void refuse_unless(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(std::string("GatedSamples: ") + what);
}

bool has_covariance(const ObserverLaw& law) {
  Eigen::VectorXd state(law.state_size());
  law.initialize(state.data());
  return law.observer().covariance(state.data()) != nullptr;
}

void check(const Gate& gate, Eigen::Index outputs, const ObserverLaw& law) {
  refuse_unless(outputs >= 0, "a gate takes a sensor that is sampled");
  refuse_unless(gate.recover_after > 0 && gate.recover_after < kLongestRecovery,
                "recover_after must be positive, and less than 104 days");
  if (gate.innovation.size() > 0) {
    refuse_unless(gate.innovation.size() == outputs && gate.innovation.minCoeff() > 0.0,
                  "one positive limit per output");
  } else {
    refuse_unless(gate.mahalanobis > 0.0, "a limit must be positive");
    refuse_unless(has_covariance(law), "a Mahalanobis distance takes a law with a covariance");
  }
}

}  // namespace

GatedSamples::GatedSamples(const std::shared_ptr<const ObserverLaw>& inner,
                           const std::vector<std::optional<Gate>>& gates)
    : LawDecorator(inner), gates_(gates.size()) {
  refuse_unless(gates.size() == inner->sensors(), "one gate, or nothing, per sensor");
  for (std::size_t i = 0; i < gates.size(); ++i) {
    if (!gates[i]) continue;
    check(*gates[i], observer().event_size(EventKind::kSample, i), *inner);
    gates_[i] = {*gates[i], GateState(state_layout(), gates[i]->recover_after)};
  }
}

void GatedSamples::initialize(double* state) const {
  law().initialize(state);
  for (const std::optional<GateInUse>& gate : gates_) {
    if (gate) gate->kept.initialize(state);
  }
}

void GatedSamples::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  for (const std::optional<GateInUse>& gate : gates_) {
    if (gate) gate->kept.advance(duration, state);
  }
}

Effect GatedSamples::reset(const Event& event, double* state, double* workspace) const {
  if (event.kind == EventKind::kSample) {
    const std::optional<GateInUse>& gate = gates_[static_cast<std::size_t>(event.sensor)];
    if (gate) return reset(*gate, event, state, workspace);
  }
  return law().reset(event, state, workspace);
}

Effect GatedSamples::reset(const GateInUse& of_sensor, const Event& sample, double* state,
                           double* workspace) const {
  const auto& [gate, kept] = of_sensor;
  switch (kept.judge(is_outside(gate, sample, state, workspace), state)) {
    case GateState::Verdict::kPass:
      return law().reset(sample, state, workspace);
    case GateState::Verdict::kReject:
      return Effect::kGated;
    case GateState::Verdict::kRecover:
      break;
  }
  const bool anew = gate.recovery == Gate::Recovery::kReset;
  if (anew) begin_anew(state, workspace);
  const Effect effect = law().reset(sample, state, workspace);
  if (!took_effect(effect)) return effect;
  return anew ? Effect::kRestarted : Effect::kPastGate;
}

bool GatedSamples::is_outside(const Gate& gate, const Event& sample, const double* state,
                              double* workspace) const {
  if (gate.innovation.size() == 0) {
    return observer().mahalanobis_distance(sample, state, workspace) > gate.mahalanobis;
  }
  double* innovation = innovation_.of(workspace);
  observer().innovation(sample, state, innovation);
  for (Eigen::Index i = 0; i < sample.size; ++i) {
    if (std::abs(innovation[i]) > gate.innovation(i)) return true;
  }
  return false;
}

void GatedSamples::begin_anew(double* state, double* workspace) const {
  double* before = before_.of(workspace);
  before_.set(state, workspace);
  initialize(state);
  observer().keep_held(observer().held_part(before), state);
  observer().keep_mode(observer().mode_of(before), state);
  // Nobody vouches for this start.
  law().distrust(state);
}

}  // namespace sampled_data_observers
