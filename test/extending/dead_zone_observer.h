// The worked example of doc/extending.md: an observer type of one's own.
#pragma once

#include "sampled_data_observers/observer/plant_observer.h"

namespace my_observers {

/// x̂⁺ = x̂ + L dz(y − h(x̂)): a constant gain that leaves innovations within ±width alone, for
/// sensors that are known to rattle.
class DeadZoneObserver : public sampled_data_observers::PlantObserver {
 public:
  /// @param L  one gain per sensor, n x m_i each   @param width  >= 0, in the outputs' units
  /// @throws std::invalid_argument when a size does not fit the plant.
  DeadZoneObserver(sampled_data_observers::ObserverContext context, std::vector<Eigen::MatrixXd> L,
                   double width);

  sampled_data_observers::LawGains gains() const override;

 protected:
  void sample(std::size_t sensor, const double* y, const Held& held, double* state,
              double* workspace) const override;

 private:
  std::vector<Eigen::MatrixXd> L_;
  double width_;
  sampled_data_observers::VectorSlot innovation_ = scratch(plant().max_outputs());
};

}  // namespace my_observers
