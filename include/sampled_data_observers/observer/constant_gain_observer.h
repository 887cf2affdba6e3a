#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sampled_data_observers/observer/linear_plant_observer.h"

namespace sampled_data_observers {

/// The observer with measurement-triggered jumps and a constant gain (ferrante2016, (3)), for
/// several sensors and a plant that may jump itself:
///
///   ẋ̂ = A x̂ + B u                       between events
///   x̂⁺ = x̂ + L_i (y_i − C_i x̂)          at a sample of sensor i
///   x̂⁺ = A_d x̂ + b_d                     at a jump of the plant
///
/// A is n x n, B n x p, C_i m_i x n, L_i n x m_i. The innovation of angular outputs is wrapped.
class ConstantGainObserver : public LinearPlantObserver {
 public:
  /// @param L  one gain per sensor of the plant, in its order; L[i] is n x m_i
  /// @throws std::invalid_argument when a size does not fit the plant.
  ConstantGainObserver(std::shared_ptr<const LinearPlant> plant, std::vector<Eigen::MatrixXd> L,
                       Eigen::VectorXd initial_estimate, Eigen::VectorXd initial_input);

 protected:
  void sample(std::size_t sensor, const double* y, double* state, double* workspace) const override;

 private:
  std::vector<Eigen::MatrixXd> L_;
};

}  // namespace sampled_data_observers
