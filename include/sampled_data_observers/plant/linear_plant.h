#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/linear_flow.h"
#include "sampled_data_observers/plant/sensor.h"

namespace sampled_data_observers {

/// x⁺ = A_d x + b_d
struct AffineJumpMap {
  Eigen::MatrixXd A_d;  ///< n x n
  Eigen::VectorXd b_d;  ///< n
};

/// What a linear plant with sporadic samples and jumps is made of:
///   ẋ = A x + B u between jumps,  x⁺ = A_d x + b_d at jumps,  y_i = C_i x at samples of sensor i.
struct LinearPlantDescription {
  std::vector<std::string> state_names;  ///< n
  std::vector<std::string> input_names;  ///< p
  Eigen::MatrixXd A;                     ///< n x n
  Eigen::MatrixXd B;                     ///< n x p
  std::vector<Sensor> sensors;
  std::optional<AffineJumpMap> jump_map;
};

/// Adds constant states (ḃ = 0, unchanged by jumps), one for each name, behind the others, so that
/// output `output` of sensor `sensor` measures the sum of what it did and the new state: a sensor
/// bias as an exosystem (ferrante2016, example 2).
struct BiasState {
  std::string name;
  std::size_t sensor = 0;
  Eigen::Index output = 0;
};
LinearPlantDescription with_bias_states(LinearPlantDescription plant,
                                        const std::vector<BiasState>& biases);

/// A checked description together with its exact flow. Immutable.
class LinearPlant {
 public:
  /// @throws std::invalid_argument naming the matrix whose shape does not fit.
  explicit LinearPlant(LinearPlantDescription description);

  const LinearPlantDescription& description() const { return description_; }
  Eigen::Index states() const { return description_.A.rows(); }
  Eigen::Index inputs() const { return description_.B.cols(); }
  const std::vector<Sensor>& sensors() const { return description_.sensors; }
  bool jumps() const { return description_.jump_map.has_value(); }

  /// Largest number of outputs of a sensor.
  Eigen::Index max_outputs() const;

  const LinearFlow& flow() const { return flow_; }

  /// x ← A_d x + b_d. `scratch`: n entries. @pre jumps()
  void jump(double* x, double* scratch) const;

 private:
  LinearPlantDescription description_;
  LinearFlow flow_;
};

}  // namespace sampled_data_observers
