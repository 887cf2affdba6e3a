#include "observer/high_gain_observer.h"

#include <stdexcept>
#include <utility>

#include "observer/observable_form.h"
#include "sampled_data_observers/linear_algebra/ordered_product.h"

namespace sampled_data_observers {
namespace {

const AffineMap& affine(const VectorMap& map, const char* name) {
  if (map.affine() == nullptr) {
    throw std::invalid_argument(std::string("the linear form takes ") + name + " by matrices only");
  }
  return *map.affine();
}

/// H: the continuous outputs of all sensors, one below the other.
Eigen::MatrixXd stacked_outputs(const Plant& plant) {
  Eigen::MatrixXd H(plant.outputs(SensorTiming::kContinuous), plant.states());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Eigen::Index m = plant.sensors()[i].outputs();
    H.middleRows(row, m) = affine(*plant.modes().front().outputs[i], "outputs").M();
    row += m;
  }
  return H;
}

}  // namespace

HighGainObserver::HighGainObserver(const ObserverContext& context, const Extras& extras,
                                   Saturation saturation)
    : PlantObserver(context, extras, {SensorTiming::kContinuous}),
      saturation_(std::move(saturation)) {
  if (saturation_.size() != n()) {
    throw std::invalid_argument("saturations: one entry per state of the plant");
  }
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
}

void HighGainObserver::check_start() const {
  Eigen::VectorXd state(state_size());
  Eigen::VectorXd workspace(workspace_size());
  Eigen::VectorXd slope(flowing_size());
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

LinearHighGainObserver::LinearHighGainObserver(const ObserverContext& context,
                                               Saturation saturation, double ell,
                                               const std::vector<Eigen::VectorXd>& K)
    : HighGainObserver(context, {0, 0, 0, context.plant->outputs(SensorTiming::kContinuous)},
                       std::move(saturation)) {
  const Eigen::MatrixXd& A = affine(*plant().modes().front().flow, "a flow").M();
  const Eigen::MatrixXd H = stacked_outputs(plant());
  L_c_ = high_gain(A, H, observable_form(A, H), ell, K);
  listed().add("ell", ell);
  for (std::size_t i = 0; i < K.size(); ++i) {
    listed().add(K.size() == 1 ? "K" : "K/" + std::to_string(i + 1), K[i].transpose());
  }
  build_flow();
}

bool LinearHighGainObserver::flow_is_affine() const {
  for (const Sensor& sensor : plant().sensors()) {
    for (const bool angular : sensor.angular) {
      if (angular) return false;
    }
  }
  return true;
}

void LinearHighGainObserver::derivative(const Held& held, const double* s, double* ds,
                                        double* workspace) const {
  PlantObserver::derivative(held, s, ds, workspace);
  if (held.y_c == nullptr) return;
  for (std::size_t i = 0; i < sensors(); ++i) {
    const Eigen::Index first = continuous_offset(i);
    compute_innovation(plant(), held.mode, i, held.y_c + first, s, held.u, workspace + first);
  }
  add_product(L_c_, workspace, ds);
}

}  // namespace sampled_data_observers
