#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "plant/jacobian.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// What a HybridKalmanFilter linearizes its plant by.
struct KalmanJacobians {
  struct OfMode {
    Jacobian flow;
    std::optional<Jacobian> jump;   ///< nothing in a mode without jump map
    std::vector<Jacobian> outputs;  ///< of each sensor
  };

  /// @param scales  n entries: sizes of usual changes of the state
  /// @throws std::invalid_argument, std::length_error as VectorMap::jacobian().
  KalmanJacobians(const Plant& plant, const Eigen::VectorXd& scales);

  /// The most that one of them needs as workspace.
  Eigen::Index workspace_size() const;

  std::vector<OfMode> modes;
};

}  // namespace sampled_data_observers
