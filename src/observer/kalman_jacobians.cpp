#include "observer/kalman_jacobians.h"

#include <algorithm>

namespace sampled_data_observers {

KalmanJacobians::KalmanJacobians(const Plant& plant, const Eigen::VectorXd& scales) {
  for (const PlantMode& mode : plant.modes()) {
    OfMode jacobians{Jacobian(mode.flow, scales), std::nullopt, {}};
    if (mode.jump) jacobians.jump.emplace(mode.jump, scales);
    for (const auto& output : mode.outputs) jacobians.outputs.emplace_back(output, scales);
    modes.push_back(std::move(jacobians));
  }
}

Eigen::Index KalmanJacobians::workspace_size() const {
  Eigen::Index most = 0;
  for (const OfMode& mode : modes) {
    most = std::max(most, mode.flow.workspace_size());
    if (mode.jump) most = std::max(most, mode.jump->workspace_size());
    for (const Jacobian& output : mode.outputs) most = std::max(most, output.workspace_size());
  }
  return most;
}

}  // namespace sampled_data_observers
