#include "sampled_data_observers/observer/plant_observer.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sampled_data_observers {

/// The derivative of a law's flowing state during one flow.
class PlantObserver::Field : public VectorField {
 public:
  Field(const PlantObserver& law, const Held& held, double* workspace)
      : law_(law), held_(held), workspace_(workspace) {}

  void evaluate(const double* x, double* dx) const override {
    law_.derivative(held_, x, dx, workspace_);
  }

 private:
  const PlantObserver& law_;
  const Held& held_;
  double* workspace_;
};

PlantObserver::PlantObserver(ObserverContext context, const Extras& extras,
                             const std::vector<SensorTiming>& timings)
    : plant_(std::move(context.plant)),
      initial_estimate_(std::move(context.initial_estimate)),
      initial_input_(std::move(context.initial_input)),
      timer_count_(extras.timers),
      law_workspace_(extras.workspace) {
  if (initial_estimate_.size() != plant_->states()) {
    throw std::invalid_argument("initial estimate: one entry per state of the plant");
  }
  if (initial_input_.size() != plant_->inputs()) {
    throw std::invalid_argument("initial input: one entry per input of the plant");
  }
  Eigen::Index continuous = 0;
  Eigen::Index at_jumps = 0;
  for (const Sensor& sensor : plant_->sensors()) {
    if (std::find(timings.begin(), timings.end(), sensor.timing) == timings.end()) {
      throw std::invalid_argument(
          "sensor '" + sensor.name +
          "': this observer takes no sensor with measured: " + to_string(sensor.timing));
    }
    Eigen::Index& offset = sensor.timing == SensorTiming::kContinuous ? continuous : at_jumps;
    offsets_.push_back(offset);
    if (sensor.timing != SensorTiming::kSampled) offset += sensor.outputs();
  }
  if (at_jumps > 0 && !plant_->jumps()) {
    throw std::invalid_argument("a plant with sensors that measure at jumps needs a jump map");
  }
  const auto count = static_cast<Eigen::Index>(plant_->sensors().size());
  layout_.constants = n() + extras.flowing;
  layout_.timers = layout_.constants + extras.constants;
  layout_.mode = layout_.timers + 1 + extras.timers;
  layout_.input = layout_.mode + 1;
  layout_.outputs = layout_.input + plant_->inputs();
  layout_.one = layout_.outputs + continuous;
  layout_.outputs_known = layout_.one + 1;
  layout_.snapshot = layout_.outputs_known + (continuous > 0 ? count : 0);
  layout_.snapshot_next = layout_.snapshot + (at_jumps > 0 ? layout_.input : 0);
  layout_.jump_outputs = layout_.snapshot_next + (at_jumps > 0 ? 1 : 0);
  layout_.jump_outputs_known = layout_.jump_outputs + at_jumps;
  layout_.size = layout_.jump_outputs_known + (at_jumps > 0 ? count : 0);
  for (std::size_t mode = 0; mode < plant_->modes().size(); ++mode) {
    std::vector<Eigen::MatrixXd>& corrections = least_corrections_.emplace_back();
    for (std::size_t i = 0; i < plant_->sensors().size(); ++i) {
      corrections.push_back(least_correction(mode, i));
    }
  }
}

void PlantObserver::build_flow() {
  if (!flow_is_affine()) {
    numeric_flow_ = std::make_unique<RungeKuttaFlow>(flowing_size(), plant_->integration().step);
    return;
  }
  Eigen::VectorXd u = Eigen::VectorXd::Zero(plant_->inputs());
  Eigen::VectorXd y_c = Eigen::VectorXd::Zero(layout_.one - layout_.outputs);
  for (std::size_t mode = 0; mode < plant_->modes().size(); ++mode) {
    exact_flows_.push_back(exact_flow({mode, u.data(), nullptr}));
    if (y_c.size() > 0) exact_flows_.push_back(exact_flow({mode, u.data(), y_c.data()}));
  }
}

std::size_t PlantObserver::regime(const Held& held) const {
  if (layout_.one == layout_.outputs) return held.mode;
  return 2 * held.mode + (held.y_c != nullptr ? 1 : 0);
}

/// The flow with the matrices of derivative(), read off column by column.
LinearFlow PlantObserver::exact_flow(const Held& held) const {
  // So far above the constant part that this costs no digit; a power of two costs none anyway.
  const double scale = std::ldexp(1.0, 200);
  const Eigen::Index inputs = layout_.one - layout_.input;
  Eigen::VectorXd s = Eigen::VectorXd::Zero(flowing_size());
  Eigen::VectorXd held_values = Eigen::VectorXd::Zero(inputs);
  Eigen::VectorXd workspace(workspace_size());
  Held at = held;
  at.u = held_values.data();
  if (held.y_c != nullptr) at.y_c = held_values.data() + plant_->inputs();

  Eigen::VectorXd constant(s.size());
  derivative(at, s.data(), constant.data(), workspace.data());
  const auto column = [&](double& variable) -> Eigen::VectorXd {
    Eigen::VectorXd result(s.size());
    variable = scale;
    derivative(at, s.data(), result.data(), workspace.data());
    variable = 0.0;
    return (result - constant) / scale;
  };
  Eigen::MatrixXd A(s.size(), s.size());
  Eigen::MatrixXd B(s.size(), inputs);
  for (Eigen::Index i = 0; i < s.size(); ++i) A.col(i) = column(s(i));
  for (Eigen::Index i = 0; i < inputs; ++i) B.col(i) = column(held_values(i));
  if (!constant.isZero(0.0)) {
    B.conservativeResize(Eigen::NoChange, inputs + 1);
    B.col(inputs) = constant;
  }
  return LinearFlow(A, B);
}

Eigen::Index PlantObserver::workspace_size() const {
  return law_workspace_ + std::max(flowing_size(), plant_->max_outputs());
}

Eigen::Index PlantObserver::event_size(EventKind kind, int channel) const {
  const auto sensor = static_cast<std::size_t>(channel);
  const bool exists = channel >= 0 && sensor < sensors();
  switch (kind) {
    case EventKind::kInput:
      return plant_->inputs() > 0 && channel == 0 ? plant_->inputs() : -1;
    case EventKind::kOutput:
      return exists && plant_->sensors()[sensor].timing == SensorTiming::kContinuous
                 ? plant_->sensors()[sensor].outputs()
                 : -1;
    case EventKind::kJumpOutput:
      return exists && plant_->sensors()[sensor].timing == SensorTiming::kAtJumps
                 ? plant_->sensors()[sensor].outputs()
                 : -1;
    case EventKind::kSample:
      return exists && plant_->sensors()[sensor].timing == SensorTiming::kSampled
                 ? plant_->sensors()[sensor].outputs()
                 : -1;
    case EventKind::kJump:
      if (!plant_->jumps()) return -1;
      if (channel == kPlainJump) return mode_values();
      return channel == kMeasuredJump && has_jump_outputs()
                 ? mode_values() + plant_->outputs(SensorTiming::kAtJumps)
                 : -1;
    case EventKind::kRelease:
    case EventKind::kRejected:
      break;
  }
  return -1;
}

Eigen::Index PlantObserver::max_event_size() const {
  return std::max({plant_->inputs(), plant_->max_outputs(),
                   mode_values() + plant_->outputs(SensorTiming::kAtJumps)});
}

void PlantObserver::initialize(double* state) const {
  std::fill_n(state, layout_.size, 0.0);
  std::copy_n(initial_input_.data(), plant_->inputs(), state + layout_.input);
  state[layout_.one] = 1.0;
  start_from(initial_estimate_.data(), state);
}

void PlantObserver::start_from(const double* estimate, double* state) const {
  if (estimate != state) std::copy_n(estimate, n(), state);
}

void PlantObserver::innovation(const Event& sample, const double* state, double* innovation) const {
  const Held now = held(state);
  compute_innovation(*plant_, now.mode, static_cast<std::size_t>(sample.channel), sample.values,
                     state, now.u, innovation);
}

PlantObserver::Held PlantObserver::held(const double* state) const {
  Held result;
  result.mode = static_cast<std::size_t>(state[layout_.mode]);
  result.u = state + layout_.input;
  if (layout_.outputs_known == layout_.snapshot) return result;
  for (std::size_t i = 0; i < sensors(); ++i) {
    if (plant_->sensors()[i].timing != SensorTiming::kContinuous) continue;
    if (state[layout_.outputs_known + static_cast<Eigen::Index>(i)] == 0.0) return result;
  }
  result.y_c = state + layout_.outputs;
  return result;
}

Duration PlantObserver::flow_step() const { return numeric_flow_ ? plant_->integration().step : 0; }

Duration PlantObserver::flow_horizon() const {
  return numeric_flow_ ? plant_->integration().horizon : ObserverLaw::flow_horizon();
}

void PlantObserver::flow(Duration duration, double* state, double* workspace) const {
  if (duration == 0) return;
  const Held now = held(state);
  flow_constants(duration, now, state, workspace);
  if (numeric_flow_) {
    numeric_flow_->apply(Field(*this, now, workspace), duration, state);
  } else {
    exact_flows_[regime(now)].apply(duration, state, state + layout_.input, workspace);
  }
  for (Eigen::Index i = 0; i <= timer_count_; ++i) {
    state[layout_.timers + i] += static_cast<double>(duration);
  }
  complete(now, state, workspace);
}

Effect PlantObserver::reset(const Event& event, double* state, double* workspace) const {
  const auto sensor = static_cast<std::size_t>(event.channel);
  switch (event.kind) {
    case EventKind::kInput:
      std::copy_n(event.values, event.size, state + layout_.input);
      break;
    case EventKind::kOutput:
      std::copy_n(event.values, event.size, state + layout_.outputs + offsets_[sensor]);
      state[layout_.outputs_known + event.channel] = 1.0;
      break;
    case EventKind::kJump:
      begin_jump(event, state, workspace);
      break;
    case EventKind::kJumpOutput:
      pair_with_jump(event, state, workspace);
      break;
    case EventKind::kSample: {
      const Held now = held(state);
      sample(sensor, event.values, now, state, workspace);
      complete(now, state, workspace);
      return Effect::kApplied;
    }
    case EventKind::kRelease:
    case EventKind::kRejected:
      return Effect::kRefused;
  }
  complete(held(state), state, workspace);
  return Effect::kApplied;
}

void PlantObserver::begin_jump(const Event& event, double* state, double* workspace) const {
  std::size_t next = 0;
  if (plant_->switches()) next = *plant_->find_mode(event.values[0]);
  if (has_jump_outputs()) {
    std::copy_n(state, layout_.input, state + layout_.snapshot);
    state[layout_.snapshot_next] = static_cast<double>(next) + 1.0;
    const bool measured = event.channel == kMeasuredJump;
    if (measured) {
      std::copy_n(event.values + mode_values(), event.size - mode_values(),
                  state + layout_.jump_outputs);
    }
    std::fill_n(state + layout_.jump_outputs_known, sensors(), measured ? 1.0 : 0.0);
  }
  apply_jump(next, state, workspace);
  // What was measured before the jump says nothing of the state after it.
  std::fill(state + layout_.outputs_known, state + layout_.snapshot, 0.0);
}

void PlantObserver::apply_jump(std::size_t next, double* state, double* workspace) const {
  jump(held(state), next, {state + layout_.jump_outputs, state + layout_.jump_outputs_known}, state,
       workspace);
  state[layout_.timers] = 0.0;
  state[layout_.mode] = static_cast<double>(next);
}

/// Applies the jump of equal stamp again, now with these of its outputs. Outputs without such a
/// jump say nothing.
void PlantObserver::pair_with_jump(const Event& output, double* state, double* workspace) const {
  const double next = state[layout_.snapshot_next] - 1.0;
  if (next < 0.0 || since_jump(state) != 0.0) return;
  const Eigen::Index offset = offsets_[static_cast<std::size_t>(output.channel)];
  std::copy_n(output.values, output.size, state + layout_.jump_outputs + offset);
  state[layout_.jump_outputs_known + output.channel] = 1.0;
  std::copy_n(state + layout_.snapshot, layout_.input, state);
  apply_jump(static_cast<std::size_t>(next), state, workspace);
}

bool PlantObserver::knows_mode(const Event& event) const {
  return event.kind != EventKind::kJump || !plant_->switches() ||
         plant_->find_mode(event.values[0]).has_value();
}

const double* PlantObserver::held_part(const double* state) const { return state + layout_.input; }

void PlantObserver::keep_held(const double* part, double* state) const {
  std::copy_n(part, layout_.snapshot - layout_.input, state + layout_.input);
}

double PlantObserver::mode_of(const double* state) const { return state[layout_.mode]; }

void PlantObserver::keep_mode(double mode, double* state) const { state[layout_.mode] = mode; }

Eigen::MatrixXd PlantObserver::least_correction(std::size_t mode, std::size_t sensor) const {
  const AffineMap* output = plant_->modes()[mode].outputs[sensor]->affine();
  if (output == nullptr) return {};
  return output->M().completeOrthogonalDecomposition().pseudoInverse();
}

void PlantObserver::fit_to(const Event& sample, double* state, double* workspace) const {
  const Held now = held(state);
  const auto sensor = static_cast<std::size_t>(sample.channel);
  const Eigen::MatrixXd& correction = least_corrections_[now.mode][sensor];
  if (correction.size() == 0) return;
  innovation(sample, state, workspace);
  for (Eigen::Index i = 0; i < n(); ++i) {
    for (Eigen::Index j = 0; j < sample.size; ++j) state[i] += correction(i, j) * workspace[j];
  }
  start_from(state, state);
}

void PlantObserver::derivative(const Held& held, const double* s, double* ds,
                               double* workspace) const {
  static_cast<void>(workspace);
  plant_->modes()[held.mode].flow->evaluate(s, held.u, ds);
  std::fill(ds + n(), ds + flowing_size(), 0.0);
}

void PlantObserver::sample(std::size_t sensor, const double* y, const Held& held, double* state,
                           double* workspace) const {
  static_cast<void>(sensor);
  static_cast<void>(y);
  static_cast<void>(held);
  static_cast<void>(state);
  static_cast<void>(workspace);
}

void PlantObserver::jump(const Held& held, std::size_t next, const JumpOutputs& outputs,
                         double* state, double* workspace) const {
  static_cast<void>(next);
  static_cast<void>(outputs);
  apply_plant_jump(held, state, workspace);
}

void PlantObserver::apply_plant_jump(const Held& held, double* state, double* workspace) const {
  const PlantMode& mode = plant_->modes()[held.mode];
  if (!mode.jump) return;
  mode.jump->evaluate(state, held.u, workspace);
  std::copy_n(workspace, n(), state);
}

void PlantObserver::flow_constants(Duration duration, const Held& held, double* state,
                                   double* workspace) const {
  static_cast<void>(duration);
  static_cast<void>(held);
  static_cast<void>(state);
  static_cast<void>(workspace);
}

void PlantObserver::complete(const Held& held, double* state, double* workspace) const {
  static_cast<void>(held);
  static_cast<void>(state);
  static_cast<void>(workspace);
}

}  // namespace sampled_data_observers
