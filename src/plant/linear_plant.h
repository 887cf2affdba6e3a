#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// x⁺ = A_d x + b_d
struct AffineJumpMap {
  Eigen::MatrixXd A_d;  ///< n x n
  Eigen::VectorXd b_d;  ///< n
};

/// y = C x, sampled
struct LinearSensor {
  std::string name;
  Eigen::MatrixXd C;          ///< m x n
  std::vector<bool> angular;  ///< m
};

/// What a linear plant of one mode with sporadic samples and jumps is made of:
///   ẋ = A x + B u between jumps,  x⁺ = A_d x + b_d at jumps,  y_i = C_i x at samples of sensor i.
struct LinearPlantDescription {
  std::vector<std::string> state_names;  ///< n
  std::vector<std::string> input_names;  ///< p
  Eigen::MatrixXd A;                     ///< n x n
  Eigen::MatrixXd B;                     ///< n x p
  std::vector<LinearSensor> sensors;
  std::optional<AffineJumpMap> jump_map;
};

/// The plant of such a description.
/// @throws std::invalid_argument naming the part that does not fit.
std::shared_ptr<const Plant> make_linear_plant(const LinearPlantDescription& description);

}  // namespace sampled_data_observers
