#pragma once

#include <Eigen/Core>
#include <vector>

#include "design/explained_trajectory.h"

namespace sampled_data_observers {

/// The maps of one step, linearized, in units of the states' largest values on the trajectory (1
/// where that is 0) and of the outputs'.
struct LinearizedStep {
  Eigen::MatrixXd A;           ///< n x n, 1/s: ∂f/∂x in the middle of the flow
  Eigen::MatrixXd transition;  ///< n x n: e^{A duration}
  Eigen::MatrixXd C;           ///< m x n: outputs that are sampled or continuous, at its begin
  Eigen::MatrixXd C_d;         ///< m_d x n: outputs at the jump that ends it; no rows without
  Eigen::MatrixXd G;           ///< n x n: ∂g/∂x; empty without jump
};

std::vector<LinearizedStep> linearize(const Plant& plant, const std::vector<TrajectoryStep>& steps);

/// What the outputs of a stretch of steps show of the state at its begin.
struct Visibility {
  double least = 0.0;  ///< least singular value of the outputs' map, root mean square over time
  double largest = 0.0;
  Eigen::VectorXd direction;  ///< n, of norm 1: what they show least
};

/// @param first, end   the steps [first, end)
/// @param with_jumps   whether the outputs at jumps count
Visibility visibility(const std::vector<TrajectoryStep>& steps,
                      const std::vector<LinearizedStep>& linear, std::size_t first, std::size_t end,
                      bool with_jumps);

}  // namespace sampled_data_observers
