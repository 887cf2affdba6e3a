#include "observer/gated_measurements.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {
namespace {

// Up to here, a sum of nanoseconds is exact, however the time is divided.
constexpr Duration kLongestRecovery = Duration{1} << 53;

void refuse_unless(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(std::string("GatedMeasurements: ") + what);
}

bool has_covariance(const ObserverLaw& law) {
  Eigen::VectorXd state(law.state_size());
  law.initialize(state.data());
  return law.observer().covariance(state.data()) != nullptr;
}

void check(const Gate& gate, Eigen::Index outputs, const ObserverLaw& law) {
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

/// What a sensor measured at a jump, as an event of its own.
Event output_of(const Event& jump, std::size_t sensor, const double* values, Eigen::Index size) {
  Event output;
  output.stamp = jump.stamp;
  output.kind = EventKind::kJumpOutput;
  output.sensor = static_cast<int>(sensor);
  output.values = values;
  output.size = size;
  return output;
}

Event without_outputs(Event jump) {
  jump.values = nullptr;
  jump.size = 0;
  return jump;
}

}  // namespace

GatedMeasurements::GatedMeasurements(const std::shared_ptr<const ObserverLaw>& inner,
                                     const std::vector<std::optional<Gate>>& gates)
    : LawDecorator(inner), gates_(gates.size()) {
  refuse_unless(gates.size() == inner->sensors(), "one gate, or nothing, per sensor");
  const std::vector<Sensor>& sensors = observer().plant().sensors();
  bool gates_jumps = false;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    if (!gates[i]) continue;
    check(*gates[i], sensors[i].outputs(), *inner);
    gates_[i] = {*gates[i], GateState(state_layout(), gates[i]->recover_after)};
    if (sensors[i].timing == SensorTiming::kAtJumps) gates_jumps = true;
  }
  standing_ = own_records();
  if (gates_jumps) keep_track_of_jumps();
  before_ = scratch(state_size());
}

void GatedMeasurements::keep_track_of_jumps() {
  const std::vector<Sensor>& sensors = observer().plant().sensors();
  Eigen::Index outputs = 0;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i].timing != SensorTiming::kAtJumps) continue;
    jump_sensors_.push_back({i, sensors[i].outputs(), outputs});
    outputs += sensors[i].outputs();
  }
  StateLayout& layout = state_layout();
  has_jumped_ = layout.flag();
  since_jump_ = layout.timer();
  before_jump_ = layout.vector(law().state_size());
  mode_ = layout.number();
  index_ = layout.number();
  y_d_ = layout.vector(outputs);
  y_d_known_ = layout.flags(sensors.size());
  own_ = layout.since(law().state_size());
  is_inside_ = scratch(static_cast<Eigen::Index>(sensors.size()));
}

void GatedMeasurements::initialize(double* state) const {
  law().initialize(state);
  own_.fill(0.0, state);
  for (const std::optional<GateInUse>& gate : gates_) {
    if (gate) gate->kept.initialize(state);
  }
}

void GatedMeasurements::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  for (const std::optional<GateInUse>& gate : gates_) {
    if (gate) gate->kept.advance(duration, state);
  }
  if (watches_jumps()) since_jump_.advance(duration, state);
}

Effect GatedMeasurements::reset(const Event& event, double* state, double* workspace) const {
  switch (event.kind) {
    case EventKind::kSample:
    case EventKind::kOutput: {
      const std::optional<GateInUse>& gate = gates_[static_cast<std::size_t>(event.sensor)];
      if (gate) return measured(*gate, event, state, workspace);
      break;
    }
    case EventKind::kJump:
      if (watches_jumps()) return jump(event, state, workspace);
      break;
    case EventKind::kJumpOutput:
      if (watches_jumps()) return jump_output(event, state, workspace);
      break;
    default:
      break;
  }
  return law().reset(event, state, workspace);
}

Effect GatedMeasurements::measured(const GateInUse& of_sensor, const Event& event, double* state,
                                   double* workspace) const {
  const auto& [gate, kept] = of_sensor;
  switch (kept.judge(is_outside(gate, event, state, workspace), state)) {
    case GateState::Verdict::kPass:
      return law().reset(event, state, workspace);
    case GateState::Verdict::kReject:
      return Effect::kGated;
    case GateState::Verdict::kRecover:
      break;
  }
  const bool anew = gate.recovery == Gate::Recovery::kReset;
  if (anew) {
    before_.set(state, workspace);
    begin_anew(before_.of(workspace), state);
  }
  const Effect effect = law().reset(event, state, workspace);
  if (!took_effect(effect)) return effect;
  return anew ? Effect::kRestarted : Effect::kPastGate;
}

Effect GatedMeasurements::jump(const Event& jump, double* state, double* workspace) const {
  before_.set(state, workspace);
  const double* before = before_.of(workspace);
  const Verdicts verdicts = judge_outputs(jump, state, workspace);
  Effect effect = verdicts.reject ? jump_with_those_inside(jump, state, workspace)
                                  : law().reset(jump, state, workspace);
  if (!took_effect(effect)) {
    // No jump was measured.
    own_.set(own_.of(before), state);
    return effect;
  }
  if (verdicts.restart) {
    begin_anew(before, state);
    before_.set(state, workspace);
    effect = law().reset(jump, state, workspace);
    if (took_effect(effect)) remember(jump, before, state);
    return took_effect(effect) ? Effect::kRestarted : effect;
  }
  remember(jump, before, state);
  if (jump.size > 0) {
    for (const JumpSensor& at : jump_sensors_) {
      y_d_known_[at.sensor].set(is_inside_.of(workspace)[at.sensor] != 0.0, state);
    }
  }
  if (verdicts.reject) return Effect::kOutputsGated;
  return verdicts.recover && effect == Effect::kApplied ? Effect::kPastGate : effect;
}

GatedMeasurements::Verdicts GatedMeasurements::judge_outputs(const Event& jump, double* state,
                                                             double* workspace) const {
  Verdicts verdicts;
  if (jump.size == 0) return verdicts;
  double* is_inside = is_inside_.of(workspace);
  for (const JumpSensor& at : jump_sensors_) {
    is_inside[at.sensor] = 1.0;
    const std::optional<GateInUse>& gate = gates_[at.sensor];
    if (!gate) continue;
    const Event output = output_of(jump, at.sensor, jump.values + at.offset, at.outputs);
    const bool outside = is_outside(gate->gate, output, state, workspace);
    switch (gate->kept.judge(outside, state)) {
      case GateState::Verdict::kPass:
        break;
      case GateState::Verdict::kReject:
        is_inside[at.sensor] = 0.0;
        verdicts.reject = true;
        break;
      case GateState::Verdict::kRecover:
        verdicts.recover = true;
        verdicts.restart |= gate->gate.recovery == Gate::Recovery::kReset;
        break;
    }
  }
  return verdicts;
}

Effect GatedMeasurements::jump_with_those_inside(const Event& jump, double* state,
                                                 double* workspace) const {
  const Effect effect = law().reset(without_outputs(jump), state, workspace);
  if (!took_effect(effect)) return effect;
  for (const JumpSensor& at : jump_sensors_) {
    if (is_inside_.of(workspace)[at.sensor] == 0.0) continue;
    law().reset(output_of(jump, at.sensor, jump.values + at.offset, at.outputs), state, workspace);
  }
  return effect;
}

/// Keeps what outputs of the same stamp, that are events of their own, need to know of a jump.
/// @param before  the state before it
void GatedMeasurements::remember(const Event& jump, const double* before, double* state) const {
  has_jumped_.set(true, state);
  since_jump_.restart(state);
  before_jump_.set(before, state);
  mode_.set(jump.mode.value_or(0.0), state);
  index_.set(static_cast<double>(jump.index), state);
  if (jump.size > 0) y_d_.set(jump.values, state);
  y_d_known_.fill(jump.size > 0, state);
}

Effect GatedMeasurements::jump_output(const Event& output, double* state, double* workspace) const {
  const bool has_jump = has_jumped_.of(state) && since_jump_.of(state) == 0.0;
  if (!has_jump) return law().reset(output, state, workspace);
  const auto sensor = static_cast<std::size_t>(output.sensor);
  bool recovers = false;
  if (const std::optional<GateInUse>& gate = gates_[sensor]) {
    const bool outside = is_outside(gate->gate, output, before_jump_.of(state), workspace);
    const GateState::Verdict verdict = gate->kept.judge(outside, state);
    if (verdict == GateState::Verdict::kReject) return Effect::kGated;
    recovers = verdict == GateState::Verdict::kRecover;
  }
  for (const JumpSensor& at : jump_sensors_) {
    if (at.sensor != sensor) continue;
    std::copy_n(output.values, at.outputs, y_d_.of(state) + at.offset);
  }
  y_d_known_[sensor].set(true, state);
  if (recovers && gates_[sensor]->gate.recovery == Gate::Recovery::kReset) {
    return jump_anew(output, state, workspace);
  }
  const Effect effect = law().reset(output, state, workspace);
  return recovers && effect == Effect::kApplied ? Effect::kPastGate : effect;
}

/// Begins anew before the last jump, of the stamp of this output, and applies it with all that was
/// measured at it.
Effect GatedMeasurements::jump_anew(const Event& output, double* state, double* workspace) const {
  before_.set(state, workspace);
  const double* before = before_.of(workspace);
  Event jump;
  jump.stamp = output.stamp;
  jump.kind = EventKind::kJump;
  jump.index = static_cast<std::uint32_t>(index_.of(before));
  if (observer().plant().switches()) jump.mode = mode_.of(before);
  begin_anew(before_jump_.of(before), state);
  before_jump_.set(state, state);
  const Effect effect = law().reset(jump, state, workspace);
  if (!took_effect(effect)) return effect;
  has_jumped_.set(true, state);
  mode_.set(mode_.of(before), state);
  index_.set(index_.of(before), state);
  y_d_.set(y_d_.of(before), state);
  for (const JumpSensor& at : jump_sensors_) {
    if (!y_d_known_[at.sensor].of(before)) continue;
    y_d_known_[at.sensor].set(true, state);
    law().reset(output_of(jump, at.sensor, y_d_.of(before) + at.offset, at.outputs), state,
                workspace);
  }
  return Effect::kRestarted;
}

bool GatedMeasurements::is_outside(const Gate& gate, const Event& event, const double* state,
                                   double* workspace) const {
  if (gate.innovation.size() == 0) {
    return observer().mahalanobis_distance(event, state, workspace) > gate.mahalanobis;
  }
  double* innovation = innovation_.of(workspace);
  observer().innovation(event, state, innovation);
  for (Eigen::Index i = 0; i < event.size; ++i) {
    if (std::abs(innovation[i]) > gate.innovation(i)) return true;
  }
  return false;
}

double GatedMeasurements::gate_share(const Event& measured, const double* state,
                                     double* workspace) const {
  const auto sensor = static_cast<std::size_t>(measured.sensor);
  if (!gates_[sensor]) return LawDecorator::gate_share(measured, state, workspace);
  const Gate& gate = gates_[sensor]->gate;
  if (gate.innovation.size() == 0) {
    return observer().mahalanobis_distance(measured, state, workspace) / gate.mahalanobis;
  }
  double* innovation = innovation_.of(workspace);
  observer().innovation(measured, state, innovation);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < measured.size; ++i) {
    largest = std::max(largest, std::abs(innovation[i]) / gate.innovation(i));
  }
  return largest;
}

/// Begins anew, with what was held in a state before, and what it knew of jumps.
void GatedMeasurements::begin_anew(const double* before, double* state) const {
  initialize(state);
  observer().keep_held(observer().held_part(before), state);
  observer().keep_mode(law().told_mode(before), state);
  keep_records_of_jumps(law(), before, law(), state);
  // Nobody vouches for this start.
  law().distrust(state);
}

}  // namespace sampled_data_observers
