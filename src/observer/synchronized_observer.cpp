#include "sampled_data_observers/observer/synchronized_observer.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/observer/gain_check.h"

namespace sampled_data_observers {

SynchronizedObserver::SynchronizedObserver(const ObserverContext& context, SynchronizedGains gains)
    : PlantObserver(context, {SensorTiming::kContinuous, SensorTiming::kAtJumps}),
      gains_(std::move(gains)) {
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
  add_innovations(gains_.L_d, held, outputs, state, correction, workspace);
  apply_plant_jump(held, state, workspace);
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

}  // namespace sampled_data_observers
