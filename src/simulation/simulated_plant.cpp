#include "simulation/simulated_plant.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sampled_data_observers/linear_algebra/ordered_product.h"
#include "sampled_data_observers/plant/linear_flow.h"
#include "sampled_data_observers/plant/runge_kutta_flow.h"

namespace sampled_data_observers {
namespace {

bool has_exact_flow(const Scenario& scenario) {
  const std::vector<PlantMode>& modes = scenario.plant->modes();
  return !scenario.disturbance &&
         std::all_of(modes.begin(), modes.end(),
                     [](const PlantMode& mode) { return mode.flow->affine() != nullptr; });
}

}  // namespace

/// How the state moves between events.
class SimulatedPlant::Flow {
 public:
  Flow() = default;
  Flow(const Flow&) = delete;
  Flow& operator=(const Flow&) = delete;
  virtual ~Flow() = default;

  /// Carries x from `time` on over `duration`.
  virtual void apply(std::size_t mode, Duration time, Duration duration, const double* u,
                     double* x) = 0;
};

class SimulatedPlant::ExactFlow : public Flow {
 public:
  ExactFlow(const Plant& plant, const std::vector<bool>& held) : scratch_(plant.states()) {
    for (const PlantMode& mode : plant.modes()) {
      const AffineMap& map = *mode.flow->affine();
      Eigen::MatrixXd A = map.M();
      Eigen::MatrixXd B = Eigen::MatrixXd::Zero(plant.states(), plant.inputs());
      B.leftCols(map.N().cols()) = map.N();
      Eigen::VectorXd b = map.c();
      for (std::size_t i = 0; i < held.size(); ++i) {
        if (!held[i]) continue;
        const auto row = static_cast<Eigen::Index>(i);
        A.row(row).setZero();
        B.row(row).setZero();
        b(row) = 0.0;
      }
      flows_.emplace_back(A, B, b);
    }
  }

  void apply(std::size_t mode, Duration, Duration duration, const double* u, double* x) override {
    flows_[mode].apply(duration, x, u, scratch_.data());
  }

 private:
  std::vector<LinearFlow> flows_;
  Eigen::VectorXd scratch_;
};

/// The time is a state of its own, for the disturbance.
class SimulatedPlant::NumericFlow : public Flow, private VectorField {
 public:
  NumericFlow(const Scenario& scenario, const std::vector<bool>& held)
      : scenario_(scenario),
        held_(held),
        flow_(scenario.plant->states() + 1, scenario.plant->integration().step),
        state_(scenario.plant->states() + 1),
        w_(scenario.disturbance ? scenario.disturbance->N.cols() : 0) {}

  void apply(std::size_t mode, Duration time, Duration duration, const double* u,
             double* x) override {
    mode_ = mode;
    u_ = u;
    const Eigen::Index n = state_.size() - 1;
    std::copy_n(x, n, state_.data());
    state_(n) = to_seconds(time);
    flow_.apply(*this, duration, state_.data());
    std::copy_n(state_.data(), n, x);
  }

 private:
  void evaluate(const double* s, double* ds) const override {
    const Eigen::Index n = state_.size() - 1;
    scenario_.plant->modes()[mode_].flow->evaluate(s, u_, ds);
    ds[n] = 1.0;
    if (scenario_.disturbance) {
      scenario_.disturbance->formulas->evaluate(s + n, nullptr, w_.data());
      add_product(scenario_.disturbance->N, w_.data(), ds);
    }
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (held_[i]) ds[i] = 0.0;
    }
  }

  const Scenario& scenario_;
  std::vector<bool> held_;
  RungeKuttaFlow flow_;
  std::size_t mode_ = 0;
  const double* u_ = nullptr;
  Eigen::VectorXd state_;  ///< (x, t)
  mutable Eigen::VectorXd w_;
};

SimulatedPlant::SimulatedPlant(const Scenario& scenario)
    : scenario_(scenario),
      x_(scenario.initial_state),
      u_(Eigen::VectorXd::Zero(scenario.plant->inputs())),
      mode_(scenario.initial_mode),
      before_(scenario.initial_state) {
  make_flow({});
  rearm();
}

SimulatedPlant::~SimulatedPlant() = default;

void SimulatedPlant::make_flow(const std::vector<bool>& held) {
  if (has_exact_flow(scenario_)) {
    flow_ = std::make_unique<ExactFlow>(*scenario_.plant, held);
  } else {
    flow_ = std::make_unique<NumericFlow>(scenario_, held);
  }
}

bool SimulatedPlant::is_finite() const { return state().allFinite() && std::isfinite(last_guard_); }

void SimulatedPlant::flow(Duration duration, Eigen::VectorXd& x) const {
  flow_->apply(mode_, time_, duration, u_.data(), x.data());
}

double SimulatedPlant::guard(const Eigen::VectorXd& x) const {
  double value = 0.0;
  scenario_.jumps->guard->evaluate(x.data(), nullptr, &value);
  return value;
}

bool SimulatedPlant::watches_guard() const {
  return scenario_.jumps && scenario_.jumps->guard && !is_at_rest_;
}

void SimulatedPlant::rearm() {
  if (!watches_guard()) return;
  last_guard_ = guard(x_);
  armed_ = last_guard_ < 0.0;
  probe_ = 1;
}

bool SimulatedPlant::flow_to(Duration target) {
  if (!watches_guard()) {
    flow(target - time_, x_);
    time_ = target;
    return false;
  }
  while (time_ < target) {
    const Duration step = std::min(probe_, target - time_);
    before_ = x_;
    flow(step, x_);
    last_guard_ = guard(x_);
    if (armed_ && last_guard_ >= 0.0) {
      locate(step);
      return true;
    }
    if (last_guard_ < 0.0) armed_ = true;
    time_ += step;
    probe_ = std::min(2 * probe_, scenario_.plant->integration().step);
  }
  return false;
}

/// Finds the jump within `step` after before_, by bisection.
void SimulatedPlant::locate(Duration step) {
  const Eigen::VectorXd start = before_;
  Duration before = 0;
  Duration after = step;
  const auto at = [&](Duration duration) {
    Eigen::VectorXd x = start;
    flow(duration, x);
    return x;
  };
  while (after - before > 1) {
    const Duration middle = before + (after - before) / 2;
    (guard(at(middle)) >= 0.0 ? after : before) = middle;
  }
  before_ = at(before);
  x_ = at(after);
  const double low = guard(before_);
  const double high = guard(x_);
  const double fraction = high > low ? std::clamp(low / (low - high), 0.0, 1.0) : 1.0;
  before_ += fraction * (x_ - before_);
  remainder_ = 1.0 - fraction;
  last_guard_ = high;
  time_ += after;
  crossing_ = true;
}

void SimulatedPlant::jump(std::size_t next_mode) {
  const PlantMode& mode = scenario_.plant->modes()[mode_];
  if (!crossing_) before_ = x_;
  if (mode.jump) {
    mode.jump->evaluate(before_.data(), u_.data(), x_.data());
  } else {
    x_ = before_;
  }
  mode_ = next_mode;
  flow_to_stamp();
  rearm();
}

void SimulatedPlant::rest() {
  const RestScenario& rest = *scenario_.jumps->rest;
  if (!crossing_) before_ = x_;
  rest.state->evaluate(before_.data(), nullptr, x_.data());
  is_at_rest_ = true;
  make_flow(rest.held);
  flow_to_stamp();
}

void SimulatedPlant::flow_to_stamp() {
  if (!crossing_) return;
  // Over less than a nanosecond, linear is exact to rounding.
  Eigen::VectorXd later = x_;
  flow(1, later);
  x_ += remainder_ * (later - x_);
  crossing_ = false;
}

void SimulatedPlant::measure(std::size_t sensor, double* out) const {
  scenario_.plant->modes()[mode_].outputs[sensor]->evaluate(state().data(), u_.data(), out);
}

}  // namespace sampled_data_observers
