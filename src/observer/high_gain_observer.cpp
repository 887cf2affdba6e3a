#include "observer/high_gain_observer.h"

#include <stdexcept>

namespace sampled_data_observers {

HighGainObserver::HighGainObserver(const ObserverContext& context, const HighGainSettings& settings,
                                   const std::vector<std::string>& maps, Eigen::Index flowing)
    : PlantObserver(context, {SensorTiming::kContinuous}, flowing), settings_(settings) {
  check_settings(settings, plant());
  listed_ = list_gains(settings, plant(), maps);
}

void HighGainObserver::check_start() const {
  Eigen::VectorXd state(state_size());
  Eigen::VectorXd workspace(workspace_size());
  Eigen::VectorXd slope(flow_size());
  initialize(state.data());
  Held now = held(state.data());
  const Eigen::VectorXd y_c = Eigen::VectorXd::Zero(plant().outputs(SensorTiming::kContinuous));
  now.y_c = y_c.data();
  derivative(now, state.data(), slope.data(), workspace.data());
  if (!state.allFinite() || !slope.allFinite()) {
    throw std::invalid_argument(
        "the observer is not defined at the initial estimate; start from another one, where T is "
        "regular");
  }
}

void HighGainObserver::jump(const Held& held, std::size_t next, const JumpOutputs& outputs,
                            double* state, double* workspace) const {
  PlantObserver::jump(held, next, outputs, state, workspace);
  saturation().apply(state);
}

}  // namespace sampled_data_observers
