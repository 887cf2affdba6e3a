#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "observer/time_varying_gain.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The observer with a gain that depends on the time since the last sample (sferlazza2019, (5)),
/// for several sensors and a linear plant that may jump itself:
///
///   ẋ̂ = A x̂ + B u                        between events
///   x̂⁺ = x̂ + K_i(τ) (y_i − C_i x̂)        at a sample of sensor i
///   x̂⁺ = g(x̂)                            at a jump of the plant
///
/// τ is the time since the last sample of any sensor, before the first one since the start: with
/// one P for all sensors, the function V = eᵀ e^{−Aᵀτ} P e^{−Aτ} e of the error e, (9), is constant
/// in flow and falls at every sample.
class TimeVaryingGainObserver : public PlantObserver {
 public:
  /// @param P  n x n, symmetric positive definite: the gains are CertificateGain. Without it they
  /// are InverseOutputGain.
  /// @param lambda  in [0, 1): how much of the error a sample keeps
  /// @throws std::invalid_argument where a gain does not fit the plant, for a plant that switches
  /// and for one whose flow or outputs are not linear (constant terms are allowed).
  TimeVaryingGainObserver(const ObserverContext& context, const std::optional<Eigen::MatrixXd>& P,
                          double lambda);

  /// P and lambda.
  LawGains gains() const override { return listed_; }

 protected:
  bool flow_is_affine() const override { return true; }
  void sample(std::size_t sensor, const double* y, const Held& held, double* state,
              double* workspace) const override;

 private:
  using Gains = std::vector<std::unique_ptr<const TimeVaryingGain>>;

  static Gains make_gains(const Plant& plant, const std::optional<Eigen::MatrixXd>& P,
                          double lambda);
  static Eigen::Index largest_workspace(const Gains& gains);
  TimeVaryingGainObserver(const ObserverContext& context, Gains gains);

  Gains gains_;               ///< one per sensor
  LinearFlow backward_flow_;  ///< of ẋ = −A x
  LawGains listed_;
  TimerSlot tau_ = timer();
  VectorSlot backward_ = scratch(n() * n());  ///< e^{−Aτ}
  VectorSlot K_ = scratch(n() * plant().max_outputs());
  VectorSlot innovation_ = scratch(plant().max_outputs());
  VectorSlot column_ = scratch(n());
  VectorSlot of_gain_ = scratch(largest_workspace(gains_));
};

}  // namespace sampled_data_observers
