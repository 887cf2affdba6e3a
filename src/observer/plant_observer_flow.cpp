// How an observer of a plant flows: exactly where that is possible, else by Runge–Kutta steps.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The derivative of a law's flowing state during one flow.
class PlantObserver::Field : public VectorField {
 public:
  Field(const PlantObserver& law, const Held& held, double* state, double* workspace)
      : law_(law), held_(held), state_(state), workspace_(workspace) {}

  void evaluate(const double* x, double* dx) const override {
    law_.derivative(held_, x, dx, workspace_);
  }
  void end_step(Duration duration, const double* before, double* x) const override {
    law_.plant().normalize(x);
    law_.confine(x);
    law_.step_constants(duration, held_, before, x, state_, workspace_);
  }

 private:
  const PlantObserver& law_;
  const Held& held_;
  double* state_;
  double* workspace_;
};

void PlantObserver::build_flow() {
  assert(!is_built() && flowing_ == s_.size());
  StateLayout& layout = state_layout();
  kept_ = layout.since(s_.size() + held_part_.size());
  y_d_ = layout.vector(plant_->outputs(SensorTiming::kAtJumps));
  if (y_d_.size() + y_c_.size() > 0) {
    s_attempted_ = scratch(s_.size());
    kept_attempted_ = scratch(kept_.size());
  }
  if (takes_jump_outputs()) {
    y_d_known_ = layout.flags(sensors());
    has_jumped_ = layout.flag();
    mode_after_jump_ = layout.mode();
    s_before_jump_ = layout.vector(s_.size());
    kept_before_jump_ = layout.vector(kept_.size());
  }
  if (!flow_is_affine()) {
    const Integration& integration = plant_->integration();
    numeric_flow_ = std::make_unique<RungeKuttaFlow>(s_.size(), integration.step);
    facts().flow_step = integration.step;
    facts().flow_horizon = integration.horizon;
    return;
  }
  const Eigen::VectorXd u = Eigen::VectorXd::Zero(u_.size());
  const Eigen::VectorXd y_c = Eigen::VectorXd::Zero(y_c_.size());
  for (std::size_t mode = 0; mode < plant_->modes().size(); ++mode) {
    exact_flows_.push_back(exact_flow({mode, u.data(), nullptr}));
    if (y_c.size() > 0) exact_flows_.push_back(exact_flow({mode, u.data(), y_c.data()}));
  }
}

std::size_t PlantObserver::regime(const Held& held) const {
  if (y_c_.size() == 0) return held.mode;
  return 2 * held.mode + (held.y_c != nullptr ? 1 : 0);
}

/// The flow with the matrices of derivative(), read off column by column.
LinearFlow PlantObserver::exact_flow(const Held& held) const {
  // So far above the constant part that this costs no digit; a power of two costs none anyway.
  const double scale = std::ldexp(1.0, 200);
  Eigen::VectorXd s = Eigen::VectorXd::Zero(s_.size());
  Eigen::VectorXd inputs = Eigen::VectorXd::Zero(inputs_.size());
  Eigen::VectorXd workspace(workspace_size());
  Held at = held;
  at.u = inputs.data();
  if (held.y_c != nullptr) at.y_c = inputs.data() + u_.size();

  Eigen::VectorXd c(s.size());
  derivative(at, s.data(), c.data(), workspace.data());
  const auto column = [&](double& variable) -> Eigen::VectorXd {
    Eigen::VectorXd result(s.size());
    variable = scale;
    derivative(at, s.data(), result.data(), workspace.data());
    variable = 0.0;
    return (result - c) / scale;
  };
  Eigen::MatrixXd A(s.size(), s.size());
  Eigen::MatrixXd B(s.size(), inputs.size());
  for (Eigen::Index i = 0; i < s.size(); ++i) A.col(i) = column(s(i));
  for (Eigen::Index i = 0; i < inputs.size(); ++i) B.col(i) = column(inputs(i));
  if (c.isZero(0.0)) return LinearFlow(A, B);
  return LinearFlow(A, B, c);
}

/// Inputs that are older than their timeout become what they are after it.
void PlantObserver::expire_inputs(double* state) const {
  for (const InputAge& age : input_ages_) {
    const InputChannel& channel = plant_->input_channels()[age.channel];
    if (channel.after_timeout.empty() || !age.timer.is_over(state)) continue;
    for (std::size_t i = 0; i < channel.inputs.size(); ++i) {
      u_.of(state)[channel.inputs[i]] = channel.after_timeout[i];
    }
  }
}

/// How long it is to the next timeout that changes an input; the longest time where there is none.
Duration PlantObserver::until_timeout(const double* state) const {
  Duration shortest = std::numeric_limits<Duration>::max();
  for (const InputAge& age : input_ages_) {
    const InputChannel& channel = plant_->input_channels()[age.channel];
    if (channel.after_timeout.empty() || age.timer.is_over(state)) continue;
    shortest = std::min(shortest, channel.timeout - static_cast<Duration>(age.timer.of(state)));
  }
  return shortest;
}

/// Where an input times out within a step of the integration, that step is made in parts, and the
/// next begins where it would have ended: so the steps are the same, however the flow is split at
/// whole ones.
void PlantObserver::flow(Duration duration, double* state, double* workspace) const {
  expire_inputs(state);
  const Duration step = flow_step();
  Duration begun = 0;  // of a step
  while (duration > 0) {
    Duration part = std::min(duration, until_timeout(state));
    if (begun > 0) {
      part = std::min(part, step - begun);
    } else if (step > 0 && part < duration && part > step) {
      part -= part % step;
    }
    flow_part(part, state, workspace);
    duration -= part;
    if (step > 0) begun = (begun + part) % step;
    expire_inputs(state);
  }
}

void PlantObserver::flow_part(Duration duration, double* state, double* workspace) const {
  const Held now = held(state);
  flow_constants(duration, now, state, workspace);
  if (numeric_flow_) {
    numeric_flow_->apply(Field(*this, now, state, workspace), duration, state);
  } else {
    exact_flows_[regime(now)].apply(duration, state, inputs_.of(state), flowed_.of(workspace));
  }
  advance_timers(duration, state);
  complete(now, state, workspace);
}

}  // namespace sampled_data_observers
