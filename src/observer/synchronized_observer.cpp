#include "sampled_data_observers/observer/synchronized_observer.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "linear_algebra/definite_matrix.h"
#include "observer/gain_requirement.h"
#include "observer/metric_gain.h"
#include "sampled_data_observers/linear_algebra/ordered_product.h"
#include "sampled_data_observers/observer/gain_check.h"

namespace sampled_data_observers {

namespace {

/// Makes the metric symmetric to the bit.
std::shared_ptr<const MetricGain> make_metric_gain(SynchronizedGains& gains, const Plant& plant) {
  if (!gains.metric) return nullptr;
  constexpr auto kAtJumps = SensorTiming::kAtJumps;
  require_of_gains(!plant.switches() && plant.is_affine(),
                   "metric: the plant's flow, jump map and outputs must be linear");
  require_of_gains(plant.outputs(kAtJumps) > 0, "metric needs a sensor that is measured at jumps");
  for (const Eigen::MatrixXd& L_d : gains.L_d) {
    require_of_gains(L_d.isZero(0.0), "one of L_d and metric, which stands for an L_d");
  }
  const Eigen::Index n = plant.states();
  gains.metric = checked_positive_definite("metric", *gains.metric, n);
  const PlantMode& mode = plant.modes().front();
  const Eigen::MatrixXd A_d =
      mode.jump ? mode.jump->affine()->M() : Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n));
  return std::make_shared<const MetricGain>(mode.flow->affine()->M(), A_d,
                                            plant.stacked_outputs(0, kAtJumps), *gains.metric);
}

}  // namespace

SynchronizedObserver::SynchronizedObserver(const ObserverContext& context, SynchronizedGains gains)
    : PlantObserver(context, {SensorTiming::kContinuous, SensorTiming::kAtJumps}),
      gains_(std::move(gains)),
      metric_gain_(make_metric_gain(gains_, plant())) {
  check_gains("L_c", gains_.L_c, plant(), SensorTiming::kContinuous);
  check_gains("L_d", gains_.L_d, plant(), SensorTiming::kAtJumps);
  for (const OutputInjection& injection : gains_.output_injections) {
    const Sensor& sensor = plant().sensors().at(injection.sensor);
    if (sensor.timing != SensorTiming::kContinuous || sensor.outputs() != 1) {
      throw std::invalid_argument("output_injection: sensor '" + sensor.name +
                                  "' must measure continuously and have one output");
    }
  }
  build_flow();
}

LawGains SynchronizedObserver::gains() const {
  LawGains all;
  all.add("L_c", gains_.L_c, plant(), SensorTiming::kContinuous);
  all.add("L_d", gains_.L_d, plant(), SensorTiming::kAtJumps);
  if (gains_.metric) all.add("metric", *gains_.metric);
  all.output_injections = gains_.output_injections;
  return all;
}

bool SynchronizedObserver::flow_is_affine() const {
  return PlantObserver::flow_is_affine() && !plant().has_angles(SensorTiming::kContinuous);
}

void SynchronizedObserver::derivative(const Held& held, const double* s, double* ds,
                                      double* workspace) const {
  if (held.y_c == nullptr) return PlantObserver::derivative(held, s, ds, workspace);
  double* x = x_.of(workspace);
  std::copy_n(s, n(), x);
  for (const OutputInjection& injection : gains_.output_injections) {
    x[injection.state] = held.y_c[output_offset(injection.sensor)];
  }
  PlantObserver::derivative(held, x, ds, workspace);
  add_innovations(gains_.L_c, held, s, ds, workspace);
}

void SynchronizedObserver::jump(const Held& held, std::size_t, const JumpOutputs& outputs,
                                double* state, double* workspace) const {
  double* correction = correction_.of(workspace);
  std::fill_n(correction, n(), 0.0);
  if (metric_gain_) {
    correct_by_metric(held, outputs, state, correction, workspace);
  } else {
    add_innovations(gains_.L_d, held, outputs, state, correction, workspace);
  }
  apply_plant_jump(held, state, workspace);
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

Eigen::Index SynchronizedObserver::metric_workspace() const {
  return metric_gain_ ? metric_gain_->workspace_size() : 0;
}

void SynchronizedObserver::correct_by_metric(const Held& held, const JumpOutputs& outputs,
                                             const double* state, double* correction,
                                             double* workspace) const {
  double* innovations = innovations_.of(workspace);
  for (const std::size_t i : sensors_of(SensorTiming::kAtJumps)) {
    const double* y_d = outputs.of(i);
    if (y_d == nullptr) return;
    compute_innovation(plant(), held.mode, i, y_d, state, held.u, innovations + output_offset(i));
  }
  double* L_d = L_d_.of(workspace);
  metric_gain_->evaluate(static_cast<Duration>(since_jump(state)), L_d,
                         metric_workspace_.of(workspace));
  add_product(L_d, n(), plant().outputs(SensorTiming::kAtJumps), innovations, correction);
}

}  // namespace sampled_data_observers
