#include "observer/linear_high_gain_observer.h"

#include <stdexcept>
#include <string>
#include <utility>

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
                                               Saturation saturation, double ell,
                                               const std::vector<Eigen::VectorXd>& K)
    : HighGainObserver(context, std::move(saturation), ell, K) {
  const PlantMode& mode = plant().modes().front();
  const Eigen::MatrixXd& A = affine(*mode.flow, "a flow").M();
  for (const auto& output : mode.outputs) affine(*output, "outputs");
  const Eigen::MatrixXd H = plant().stacked_outputs(0, SensorTiming::kContinuous);
  const Eigen::MatrixXd L_c = high_gain(A, H, observable_form(A, H), ell, K);
  for (std::size_t i = 0; i < sensors(); ++i) {
    L_c_.emplace_back(L_c.middleCols(output_offset(i), plant().sensors()[i].outputs()));
  }
  build_flow();
}

bool LinearHighGainObserver::flow_is_affine() const {
  return !plant().has_angles(SensorTiming::kContinuous);
}

void LinearHighGainObserver::derivative(const Held& held, const double* s, double* ds,
                                        double* workspace) const {
  PlantObserver::derivative(held, s, ds, workspace);
  add_innovations(L_c_, held, s, ds, workspace);
}

}  // namespace sampled_data_observers
