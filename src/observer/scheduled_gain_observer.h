#pragma once

#include <vector>

#include "observer/scheduled_gain.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The observer with gains that depend on the times since the last sample of each sensor, for a
/// plant that may be nonlinear and jump itself:
///
///   ẋ̂ = f(x̂, u)                           between events
///   x̂⁺ = x̂ + K_i(τ) (y_i − h_i(x̂)),       at a sample of sensor i, with K_i(τ) of ScheduledGain;
///   τ_i⁺ = 0
///   x̂⁺ = g(x̂)                              at a jump of the plant
///
/// τ has one entry per sensor: the time since its last sample, before the first one since the
/// start. The innovation of angular outputs is wrapped.
class ScheduledGainObserver : public PlantObserver {
 public:
  /// @throws std::invalid_argument as ScheduledGain does.
  ScheduledGainObserver(ObserverContext context, ScheduledGains gains);

  /// As ScheduledGain::list() has them.
  LawGains gains() const override;

 protected:
  void sample(std::size_t sensor, const double* y, const Held& held, double* state,
              double* workspace) const override;

 private:
  ScheduledGain gain_;
  std::vector<TimerSlot> since_sample_;  ///< one per sensor
  VectorSlot tau_ = scratch(static_cast<Eigen::Index>(plant().sensors().size()));
  VectorSlot K_ = scratch(n() * plant().max_outputs());
  VectorSlot innovation_ = scratch(plant().max_outputs());
  VectorSlot of_gain_ = scratch(gain_.workspace_size());
};

}  // namespace sampled_data_observers
