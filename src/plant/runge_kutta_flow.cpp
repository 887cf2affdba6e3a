#include "sampled_data_observers/plant/runge_kutta_flow.h"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta4_classic.hpp>
#include <vector>

namespace sampled_data_observers {

struct RungeKuttaFlow::Stepper {
  using State = std::vector<double>;
  boost::numeric::odeint::runge_kutta4_classic<State> stepper;
  State x;
  State before;  ///< the step
};

void VectorField::end_step(Duration, const double*, double*) const {}

RungeKuttaFlow::RungeKuttaFlow(Eigen::Index states, Duration step)
    : step_(step), stepper_(std::make_unique<Stepper>()) {
  stepper_->x.resize(static_cast<std::size_t>(states));
  stepper_->before.resize(stepper_->x.size());
  stepper_->stepper.adjust_size(stepper_->x);
}

RungeKuttaFlow::~RungeKuttaFlow() = default;

void RungeKuttaFlow::apply(const VectorField& field, Duration duration, double* x) const {
  std::vector<double>& state = stepper_->x;
  std::copy_n(x, state.size(), state.begin());
  const auto system = [&field](const std::vector<double>& at, std::vector<double>& dx, double) {
    field.evaluate(at.data(), dx.data());
  };
  while (duration > 0) {
    const Duration step = std::min(duration, step_);
    std::copy(state.begin(), state.end(), stepper_->before.begin());
    stepper_->stepper.do_step(system, state, 0.0, to_seconds(step));
    field.end_step(step, stepper_->before.data(), state.data());
    duration -= step;
  }
  std::copy_n(state.begin(), state.size(), x);
}

}  // namespace sampled_data_observers
