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

}  // namespace

HighGainObserver::HighGainObserver(const ObserverContext& context, Saturation saturation,
                                   Eigen::Index flowing)
    : PlantObserver(context, {SensorTiming::kContinuous}, flowing),
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

LinearHighGainObserver::LinearHighGainObserver(const ObserverContext& context,
                                               Saturation saturation, double ell,
                                               const std::vector<Eigen::VectorXd>& K)
    : HighGainObserver(context, std::move(saturation)) {
  const PlantMode& mode = plant().modes().front();
  const Eigen::MatrixXd& A = affine(*mode.flow, "a flow").M();
  for (const auto& output : mode.outputs) affine(*output, "outputs");
  const Eigen::MatrixXd H = plant().stacked_outputs(0, SensorTiming::kContinuous);
  L_c_ = high_gain(A, H, observable_form(A, H), ell, K);
  listed().add("ell", ell);
  for (std::size_t i = 0; i < K.size(); ++i) {
    listed().add(K.size() == 1 ? "K" : "K/" + std::to_string(i + 1), K[i].transpose());
  }
  build_flow();
}

bool LinearHighGainObserver::flow_is_affine() const {
  return !plant().has_angles(SensorTiming::kContinuous);
}

void LinearHighGainObserver::derivative(const Held& held, const double* s, double* ds,
                                        double* workspace) const {
  PlantObserver::derivative(held, s, ds, workspace);
  if (held.y_c == nullptr) return;
  double* innovations = innovations_.of(workspace);
  for (std::size_t i = 0; i < sensors(); ++i) {
    const Eigen::Index first = output_offset(i);
    compute_innovation(plant(), held.mode, i, held.y_c + first, s, held.u, innovations + first);
  }
  add_product(L_c_, innovations, ds);
}

}  // namespace sampled_data_observers
