#include "sampled_data_observers/observer/synchronized_observer.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sampled_data_observers/linear_algebra/ordered_product.h"
#include "sampled_data_observers/observer/gain_check.h"

namespace sampled_data_observers {

SynchronizedObserver::SynchronizedObserver(const ObserverContext& context, SynchronizedGains gains)
    // Scratch for x̂ with injected outputs, one innovation, and the sum of innovations at a jump.
    : PlantObserver(context, {0, 0, 0, 2 * context.plant->states() + context.plant->max_outputs()},
                    {SensorTiming::kContinuous, SensorTiming::kAtJumps}),
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
  const std::vector<Sensor>& sensors = plant().sensors();
  return PlantObserver::flow_is_affine() &&
         std::none_of(sensors.begin(), sensors.end(), [](const Sensor& sensor) {
           return sensor.timing == SensorTiming::kContinuous &&
                  std::find(sensor.angular.begin(), sensor.angular.end(), true) !=
                      sensor.angular.end();
         });
}

void SynchronizedObserver::derivative(const Held& held, const double* s, double* ds,
                                      double* workspace) const {
  if (held.y_c == nullptr) return PlantObserver::derivative(held, s, ds, workspace);
  double* x = workspace;
  double* innovation = workspace + n();
  std::copy_n(s, n(), x);
  for (const OutputInjection& injection : gains_.output_injections) {
    x[injection.state] = held.y_c[continuous_offset(injection.sensor)];
  }
  PlantObserver::derivative(held, x, ds, nullptr);
  for (std::size_t i = 0; i < sensors(); ++i) {
    if (plant().sensors()[i].timing != SensorTiming::kContinuous) continue;
    compute_innovation(plant(), held.mode, i, held.y_c + continuous_offset(i), s, held.u,
                       innovation);
    add_product(gains_.L_c[i], innovation, ds);
  }
}

void SynchronizedObserver::jump(const Held& held, std::size_t next, const JumpOutputs& outputs,
                                double* state, double* workspace) const {
  static_cast<void>(next);
  double* correction = workspace + n();
  double* innovation = correction + n();
  std::fill_n(correction, n(), 0.0);
  for (std::size_t i = 0; i < sensors(); ++i) {
    if (plant().sensors()[i].timing != SensorTiming::kAtJumps || outputs.known[i] == 0.0) continue;
    compute_innovation(plant(), held.mode, i, outputs.y_d + jump_output_offset(i), state, held.u,
                       innovation);
    add_product(gains_.L_d[i], innovation, correction);
  }
  apply_plant_jump(held, state, workspace);
  for (Eigen::Index i = 0; i < n(); ++i) state[i] += correction[i];
}

}  // namespace sampled_data_observers
