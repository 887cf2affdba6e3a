#include "observer/linear_high_gain_observer.h"

#include <stdexcept>
#include <string>

#include "observer/observable_form.h"

namespace sampled_data_observers {
namespace {

const AffineMap& affine(const VectorMap& map, const char* name) {
  if (map.affine() == nullptr) {
    throw std::invalid_argument(std::string("the linear form takes ") + name + " by matrices only");
  }
  return *map.affine();
}

}  // namespace

LinearHighGainObserver::LinearHighGainObserver(const ObserverContext& context,
                                               const HighGainSettings& settings)
    : HighGainObserver(context, settings) {
  for (std::size_t q = 0; q < plant().modes().size(); ++q) {
    const PlantMode& mode = plant().modes()[q];
    const Eigen::MatrixXd& A = affine(*mode.flow, "a flow").M();
    for (const auto& output : mode.outputs) affine(*output, "outputs");
    const Eigen::MatrixXd H = plant().stacked_outputs(q, SensorTiming::kContinuous);
    const Eigen::MatrixXd L_c = high_gain(A, H, observable_form(A, H), settings.ell, settings.K[q]);
    std::vector<Eigen::MatrixXd>& per_sensor = L_c_.emplace_back();
    for (std::size_t i = 0; i < sensors(); ++i) {
      per_sensor.emplace_back(L_c.middleCols(output_offset(i), plant().sensors()[i].outputs()));
    }
  }
  build_flow();
}

bool LinearHighGainObserver::flow_is_affine() const {
  return !plant().has_angles(SensorTiming::kContinuous);
}

void LinearHighGainObserver::derivative(const Held& held, const double* s, double* ds,
                                        double* workspace) const {
  PlantObserver::derivative(held, s, ds, workspace);
  add_innovations(L_c_[held.mode], held, s, ds, workspace);
}

}  // namespace sampled_data_observers
