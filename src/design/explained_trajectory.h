#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// A flow of the plant, and the jump that ends it, if one does.
struct TrajectoryStep {
  double t = 0.0;         ///< where it begins [s]
  double duration = 0.0;  ///< [s]
  Eigen::VectorXd begin;  ///< n: the state there
  Eigen::VectorXd end;    ///< n: at its end, before the jump
  Eigen::VectorXd u;      ///< p: the input meanwhile
  std::size_t mode = 0;   ///< position among the plant's modes
  bool jumps = false;
};

/// The coordinates of a high-gain observer, for what is said of their Jacobian.
struct TrajectoryCoordinates {
  /// Per mode: n to d
  std::vector<std::shared_ptr<const VectorMap>> T;
  Eigen::VectorXd powers;             ///< d: what its rows count, as inverse_powers() has it
  Eigen::VectorXd scales;             ///< n: sizes of usual changes of the states
  std::vector<Eigen::Index> outputs;  ///< its rows that are outputs
};

/// What the linearization along one trajectory of a plant shows, in words: how it grows, what its
/// outputs show between jumps and over jumps, and, with coordinates, where ∂T/∂x is singular.
/// Jumps are taken as told to the observer, as bernard2022 does. Estimates, about this trajectory
/// alone. Lines of at most 96 columns.
/// @param coordinates  may be null
std::string explain_trajectory(const Plant& plant, const std::vector<TrajectoryStep>& steps,
                               const TrajectoryCoordinates* coordinates);

}  // namespace sampled_data_observers
