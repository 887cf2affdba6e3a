#pragma once

#include <Eigen/Core>
#include <vector>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The gains of one sensor: L is n x m, H is m x m.
struct IntersampleGains {
  Eigen::MatrixXd L;
  Eigen::MatrixXd H;
  Eigen::VectorXd initial_theta;  ///< m: θ before the first sample
};

/// H = −C L: between samples θ follows the predicted output error (ferrante2019, remark 5).
/// @pre the sensor's output map is affine in every mode and the same in all
Eigen::MatrixXd predictor_H(const Plant& plant, std::size_t sensor, const Eigen::MatrixXd& L);

/// The observer with intersample injection (ferrante2019, (4)), for several sensors:
///
///   ẋ̂ = f(x̂, u) + Σ L_i θ_i,  θ̇_i = H_i θ_i    between events
///   θ_i⁺ = y_i − h_i(x̂)                         at a sample of sensor i
///   x̂⁺ = g(x̂)                                   at a jump of the plant
///
/// H_i = −C_i L_i gives the predictor, H_i = 0 the zero-order hold. L_i is n x m_i, H_i m_i x m_i.
/// The innovation of angular outputs is wrapped. θ stays at a jump of the plant.
class IntersampleInjectionObserver : public PlantObserver {
 public:
  /// @param gains  one per sensor of the plant, in its order
  /// @throws std::invalid_argument when a size does not fit the plant.
  IntersampleInjectionObserver(const ObserverContext& context, std::vector<IntersampleGains> gains);

  LawGains gains() const override;
  void initialize(double* state) const override;

 protected:
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;
  void sample(std::size_t sensor, const double* y, const Held& held, double* state,
              double* workspace) const override;

 private:
  std::vector<IntersampleGains> gains_;
  std::vector<VectorSlot> theta_;  ///< of each sensor
};

}  // namespace sampled_data_observers
