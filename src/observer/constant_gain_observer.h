#pragma once

#include <Eigen/Core>
#include <vector>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The observer with measurement-triggered jumps and a constant gain (ferrante2016, (3)), for
/// several sensors and a plant that may be nonlinear and jump itself:
///
///   ẋ̂ = f(x̂, u)                        between events; A x̂ + B u in the paper
///   x̂⁺ = x̂ + L_i (y_i − h_i(x̂))        at a sample of sensor i
///   x̂⁺ = g(x̂)                           at a jump of the plant
///
/// L_i is n x m_i. The innovation of angular outputs is wrapped.
class ConstantGainObserver : public PlantObserver {
 public:
  /// @param L  one gain per sensor of the plant, in its order; L[i] is n x m_i
  /// @throws std::invalid_argument when a size does not fit the plant.
  ConstantGainObserver(ObserverContext context, std::vector<Eigen::MatrixXd> L);

  LawGains gains() const override {
    return LawGains().add("L", L_, plant(), SensorTiming::kSampled);
  }

 protected:
  void sample(std::size_t sensor, const double* y, const Held& held, double* state,
              double* workspace) const override;

 private:
  std::vector<Eigen::MatrixXd> L_;
  VectorSlot innovation_ = scratch(plant().max_outputs());
};

}  // namespace sampled_data_observers
