#include "observer/high_gain_observer.h"

#include <stdexcept>
#include <utility>

#include "observer/gain_requirement.h"

namespace sampled_data_observers {

HighGainObserver::HighGainObserver(const ObserverContext& context, Saturation saturation,
                                   double ell, const std::vector<Eigen::VectorXd>& K,
                                   const std::vector<std::string>& maps, Eigen::Index flowing)
    : PlantObserver(context, {SensorTiming::kContinuous}, flowing),
      saturation_(std::move(saturation)) {
  require_of_gains(saturation_.size() == n(), "saturations: one entry per state of the plant");
  if (plant().switches()) {
    throw std::invalid_argument("the plant must have one mode only");
  }
  if (plant().sensors().empty()) {
    throw std::invalid_argument("a sensor that is measured continuously is needed");
  }
  for (Eigen::Index i = 0; i < n(); ++i) {
    const std::string& state = plant().state_names()[static_cast<std::size_t>(i)];
    if (const auto bounds = saturation_.bounds(i)) listed_.add("saturations/" + state, *bounds);
  }
  listed_.add("ell", ell);
  for (std::size_t i = 0; i < K.size(); ++i) {
    listed_.add(K.size() == 1 ? "K" : "K/" + std::to_string(i + 1), K[i].transpose());
  }
  for (const std::string& map : maps) listed_.add(map, Eigen::MatrixXd());
}

void HighGainObserver::require_one_output() const {
  if (plant().sensors().size() != 1 || plant().max_outputs() != 1) {
    throw std::invalid_argument("this form takes one continuous sensor with one output");
  }
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
  saturation_.apply(state);
}

}  // namespace sampled_data_observers
