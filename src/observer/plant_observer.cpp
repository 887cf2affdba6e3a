#include "sampled_data_observers/observer/plant_observer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "linear_algebra/matrix_functions.h"
#include "sampled_data_observers/hybrid/split_flow.h"
#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {
namespace {

/// What makes of the innovation of an affine output the least change of x̂ that removes it.
Eigen::MatrixXd least_correction(const VectorMap& output) {
  if (output.affine() == nullptr) return {};
  return pseudo_inverse(output.affine()->M());
}

}  // namespace

PlantObserver::PlantObserver(ObserverContext context, const std::vector<SensorTiming>& timings,
                             Eigen::Index flowing)
    : ObserverLaw(this),
      plant_(std::move(context.plant)),
      initial_estimate_(std::move(context.initial_estimate)),
      initial_input_(std::move(context.initial_input)) {
  const std::vector<Sensor>& all = plant_->sensors();
  if (initial_estimate_.size() != plant_->states()) {
    throw std::invalid_argument("initial estimate: one entry per state of the plant");
  }
  if (initial_input_.size() != plant_->inputs()) {
    throw std::invalid_argument("initial input: one entry per input of the plant");
  }
  std::array<Eigen::Index, 3> outputs = {};
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::find(timings.begin(), timings.end(), all[i].timing) == timings.end()) {
      throw std::invalid_argument(
          "sensor '" + all[i].name +
          "': this observer takes no sensor with measured: " + to_string(all[i].timing));
    }
    const auto timing = static_cast<std::size_t>(all[i].timing);
    sensors_of_[timing].push_back(i);
    offsets_.push_back(outputs[timing]);
    outputs[timing] += all[i].outputs();
  }
  if (plant_->outputs(SensorTiming::kAtJumps) > 0 && !plant_->jumps()) {
    throw std::invalid_argument("a plant with sensors that measure at jumps needs a jump map");
  }
  for (const PlantMode& mode : plant_->modes()) {
    std::vector<Eigen::MatrixXd>& corrections = least_corrections_.emplace_back();
    for (const auto& output : mode.outputs) corrections.push_back(least_correction(*output));
  }
  covariance_sizes_.resize(all.size());
  facts().sensors = all.size();
  facts().max_event_size =
      std::max({plant_->inputs(), plant_->max_outputs(), plant_->outputs(SensorTiming::kAtJumps)});
  StateLayout& layout = state_layout();
  s_ = layout.vector(n() + flowing);
  flowing_ = n();
  const Eigen::Index continuous = plant_->outputs(SensorTiming::kContinuous);
  inputs_ = layout.vector(plant_->inputs() + continuous);
  u_ = inputs_.part(0, plant_->inputs());
  y_c_ = inputs_.part(plant_->inputs(), continuous);
  y_c_known_ = layout.flags(y_c_.size() > 0 ? all.size() : 0);
  for (std::size_t i = 0; i < plant_->input_channels().size(); ++i) {
    const Duration timeout = plant_->input_channels()[i].timeout;
    if (timeout > 0) input_ages_.push_back({i, layout.timer(static_cast<double>(timeout))});
  }
  held_part_ = layout.since(s_.size());
  mode_ = layout.mode();
  since_jump_ = timer();
  flowed_ = scratch(s_.size());
  jumped_ = scratch(n());
  innovation_ = scratch(plant_->max_outputs());
}

VectorSlot PlantObserver::flowing(Eigen::Index entries) {
  const VectorSlot next = s_.part(flowing_, entries);
  flowing_ += entries;
  return next;
}

VectorSlot PlantObserver::constants(Eigen::Index entries) {
  assert(!is_built());
  return state_layout().vector(entries);
}

void PlantObserver::take_covariance_with(std::size_t sensor) {
  const Eigen::Index m = plant_->sensors()[sensor].outputs();
  covariance_sizes_[sensor] = m * (m + 1) / 2;
  facts().max_event_size = std::max(facts().max_event_size, m + covariance_sizes_[sensor]);
}

TimerSlot PlantObserver::timer() {
  assert(!is_built());
  return state_layout().timer();
}

Eigen::Index PlantObserver::event_size(EventKind kind, std::size_t sensor) const {
  const auto outputs = [&](SensorTiming timing) -> Eigen::Index {
    if (sensor >= sensors() || plant_->sensors()[sensor].timing != timing) return -1;
    return plant_->sensors()[sensor].outputs();
  };
  switch (kind) {
    case EventKind::kInput:
      return sensor < plant_->input_channels().size() ? plant_->input_channels()[sensor].size()
                                                      : -1;
    case EventKind::kOutput:
      return outputs(SensorTiming::kContinuous);
    case EventKind::kJumpOutput:
      return outputs(SensorTiming::kAtJumps);
    case EventKind::kSample:
      return outputs(SensorTiming::kSampled);
    case EventKind::kJump:
    case EventKind::kWithdrawal:
      return plant_->jumps() ? plant_->outputs(SensorTiming::kAtJumps) : -1;
    case EventKind::kRelease:
    case EventKind::kRejected:
      break;
  }
  return -1;
}

bool PlantObserver::accepts(const Event& event) const {
  const Eigen::Index size = event_size(event.kind, static_cast<std::size_t>(event.sensor));
  const bool is_jump = event.kind == EventKind::kJump || event.kind == EventKind::kWithdrawal;
  const bool is_sample = event.kind == EventKind::kSample && size >= 0;
  const Eigen::Index covariance =
      is_sample ? covariance_sizes_[static_cast<std::size_t>(event.sensor)] : 0;
  if (event.covariance != covariance) return false;
  if (!is_jump) return size >= 0 && event.size == size;
  return size >= 0 && (event.size == 0 || event.size == size) &&
         event.mode.has_value() == plant_->switches();
}

void PlantObserver::initialize(double* state) const {
  std::fill_n(state, state_size(), 0.0);
  u_.set(initial_input_.data(), state);
  start_from(initial_estimate_.data(), state);
}

void PlantObserver::keep_mode(std::size_t mode, double* state) const { mode_.set(mode, state); }

void PlantObserver::start_from(const double* estimate, double* state) const {
  if (estimate != state) std::copy_n(estimate, n(), state);
  plant_->normalize(state);
}

PlantObserver::Held PlantObserver::held(const double* state) const {
  Held result{mode_.of(state), u_.of(state), nullptr};
  if (y_c_.size() == 0) return result;
  for (const std::size_t i : sensors_of(SensorTiming::kContinuous)) {
    if (!y_c_known_[i].of(state)) return result;
  }
  result.y_c = y_c_.of(state);
  return result;
}

Effect PlantObserver::reset(const Event& event, double* state, double* workspace) const {
  const auto sensor = static_cast<std::size_t>(event.sensor);
  Effect effect = Effect::kApplied;
  expire_inputs(state);
  switch (event.kind) {
    case EventKind::kInput:
      take_input(event, state);
      break;
    case EventKind::kOutput:
      y_c_.part(output_offset(sensor), event.size).set(event.values, state);
      y_c_known_[sensor].set(true, state);
      break;
    case EventKind::kJump:
      effect = begin_jump(event, state, workspace);
      break;
    case EventKind::kJumpOutput:
      effect = pair_with_jump(event, state, workspace);
      break;
    case EventKind::kSample: {
      const Held now = held(state);
      sample(sensor, event.values, now, state, workspace);
      plant_->normalize(state);
      complete(now, state, workspace);
      return Effect::kApplied;
    }
    case EventKind::kRelease:
    case EventKind::kRejected:
    case EventKind::kWithdrawal:
      return Effect::kRefused;
  }
  complete(held(state), state, workspace);
  return effect;
}

/// The inputs of its channel; the others go on holding.
void PlantObserver::take_input(const Event& event, double* state) const {
  const InputChannel& channel = plant_->input_channels()[static_cast<std::size_t>(event.sensor)];
  for (std::size_t i = 0; i < channel.inputs.size(); ++i) {
    u_.of(state)[channel.inputs[i]] = event.values[i];
  }
  for (const InputAge& age : input_ages_) {
    if (age.channel == static_cast<std::size_t>(event.sensor)) age.timer.restart(state);
  }
}

bool PlantObserver::is_input_stale(const double* state) const {
  return std::any_of(input_ages_.begin(), input_ages_.end(),
                     [state](const InputAge& age) { return age.timer.is_over(state); });
}

Effect PlantObserver::begin_jump(const Event& event, double* state, double* workspace) const {
  std::size_t next = 0;
  if (plant_->switches()) next = *plant_->find_mode(*event.mode);
  if (takes_jump_outputs()) {
    s_before_jump_.set(s_.of(state), state);
    kept_before_jump_.set(kept_.of(state), state);
    has_jumped_.set(true, state);
    mode_after_jump_.set(next, state);
    const bool measured = event.size > 0;
    if (measured) y_d_.set(event.values, state);
    y_d_known_.fill(measured, state);
  }
  const Effect effect = apply_jump(next, state, workspace);
  // What was measured before the jump says nothing of the state after it.
  y_c_known_.fill(false, state);
  return effect;
}

Effect PlantObserver::apply_jump(std::size_t next, double* state, double* workspace) const {
  Effect effect = Effect::kApplied;
  const Held now = held(state);
  const bool is_attempt = s_attempted_.size() > 0;
  if (is_attempt) {
    s_attempted_.set(s_.of(state), workspace);
    kept_attempted_.set(kept_.of(state), workspace);
  }
  jump(now, next, JumpOutputs(*this, state), state, workspace);
  if (is_attempt && !is_usable_after_jump(state)) {
    s_.set(s_attempted_.of(workspace), state);
    kept_.set(kept_attempted_.of(workspace), state);
    jump({now.mode, now.u, nullptr}, next, JumpOutputs(), state, workspace);
    effect = Effect::kWithoutOutputs;
  }
  plant_->normalize(state);
  since_jump_.restart(state);
  mode_.set(next, state);
  return effect;
}

bool PlantObserver::is_usable_after_jump(const double* state) const {
  const auto usable = [state](const VectorSlot& slot) {
    return is_usable(Eigen::Map<const Eigen::VectorXd>(slot.of(state), slot.size()));
  };
  return usable(s_) && usable(kept_);
}

/// Applies the jump of equal stamp again, now with these of its outputs. Outputs without such a
/// jump say nothing.
Effect PlantObserver::pair_with_jump(const Event& output, double* state, double* workspace) const {
  if (!has_jumped_.of(state) || since_jump(state) != 0.0) return Effect::kApplied;
  const auto sensor = static_cast<std::size_t>(output.sensor);
  y_d_.part(output_offset(sensor), output.size).set(output.values, state);
  y_d_known_[sensor].set(true, state);
  s_.set(s_before_jump_.of(state), state);
  kept_.set(kept_before_jump_.of(state), state);
  return apply_jump(mode_after_jump_.of(state), state, workspace);
}

bool PlantObserver::knows_mode(const Event& event) const {
  return !event.mode || !plant_->switches() || plant_->find_mode(*event.mode).has_value();
}

void PlantObserver::innovation(const Event& sample, const double* state, double* innovation) const {
  const Held now = held(state);
  compute_innovation(*plant_, now.mode, static_cast<std::size_t>(sample.sensor), sample.values,
                     state, now.u, innovation);
}

std::optional<double> PlantObserver::innovation_of_held(const double* state,
                                                        double* workspace) const {
  const Held now = held(state);
  if (now.y_c == nullptr) return std::nullopt;
  double* innovation = innovation_.of(workspace);
  double sum = 0.0;
  for (const std::size_t i : sensors_of(SensorTiming::kContinuous)) {
    compute_innovation(*plant_, now.mode, i, now.y_c + output_offset(i), state, now.u, innovation);
    for (Eigen::Index j = 0; j < plant_->sensors()[i].outputs(); ++j) {
      sum += innovation[j] * innovation[j];
    }
  }
  return std::sqrt(sum);
}

void PlantObserver::fit_to(const Event& sample, double* state, double* workspace) const {
  const auto sensor = static_cast<std::size_t>(sample.sensor);
  const Eigen::MatrixXd& correction = least_corrections_[mode_.of(state)][sensor];
  if (correction.size() == 0) return;
  double* innovation = innovation_.of(workspace);
  this->innovation(sample, state, innovation);
  for (Eigen::Index i = 0; i < n(); ++i) {
    for (Eigen::Index j = 0; j < sample.size; ++j) state[i] += correction(i, j) * innovation[j];
  }
  start_from(state, state);
}

const double* PlantObserver::covariance(const double*) const { return nullptr; }

double PlantObserver::mahalanobis_distance(const Event&, const double*, double*) const {
  return std::numeric_limits<double>::quiet_NaN();
}

bool PlantObserver::is_saturated(const double*) const { return false; }

void PlantObserver::derivative(const Held& held, const double* s, double* ds, double*) const {
  plant_->modes()[held.mode].flow->evaluate(s, held.u, ds);
  std::fill(ds + n(), ds + flow_size(), 0.0);
}

void PlantObserver::confine(double*) const {}

void PlantObserver::sample(std::size_t, const double*, const Held&, double*, double*) const {}

void PlantObserver::jump(const Held& held, std::size_t, const JumpOutputs&, double* state,
                         double* workspace) const {
  apply_plant_jump(held, state, workspace);
}

void PlantObserver::flow_constants(Duration, const Held&, double*, double*) const {}

void PlantObserver::step_constants(Duration, const Held&, const double*, double*, double*,
                                   double*) const {}

void PlantObserver::complete(const Held&, double*, double*) const {}

void PlantObserver::apply_plant_jump(const Held& held, double* state, double* workspace) const {
  const PlantMode& mode = plant_->modes()[held.mode];
  if (!mode.jump) return;
  double* jumped = jumped_.of(workspace);
  mode.jump->evaluate(state, held.u, jumped);
  std::copy_n(jumped, n(), state);
}

void PlantObserver::add_innovations(const std::vector<Eigen::MatrixXd>& L, const Held& held,
                                    const double* x, double* dx, double* workspace) const {
  if (held.y_c == nullptr) return;
  double* innovation = innovation_.of(workspace);
  for (const std::size_t i : sensors_of(SensorTiming::kContinuous)) {
    compute_innovation(*plant_, held.mode, i, held.y_c + output_offset(i), x, held.u, innovation);
    add_product(L[i], innovation, dx);
  }
}

void PlantObserver::add_innovations(const std::vector<Eigen::MatrixXd>& L, const Held& held,
                                    const JumpOutputs& outputs, const double* x, double* dx,
                                    double* workspace) const {
  double* innovation = innovation_.of(workspace);
  for (const std::size_t i : sensors_of(SensorTiming::kAtJumps)) {
    const double* y_d = outputs.of(i);
    if (y_d == nullptr) continue;
    compute_innovation(*plant_, held.mode, i, y_d, x, held.u, innovation);
    add_product(L[i], innovation, dx);
  }
}

}  // namespace sampled_data_observers
