#pragma once

#include <algorithm>
#include <vector>

#include "observer/switched_gains.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// Observers of a switched plant with affine modes and known mode q (bernard2022, section 7.3):
///
///   ẋ̂ = A_q x̂ + B_q u + b_q + L_c,q (y_c − H_q x̂)     in mode q
///   x̂⁺ = A_d,q x̂ + b_d,q + L_d,q(τ) (y_d − H_q x̂)      at a switch that leaves mode q
///
/// with τ the time since the switch before, or the start; L_d may be given, or follow from metrics
/// (MetricGain), for which all of y_d must be known. Where mode q has a metric and its jump
/// map is the identity, x̂ is first projected along the metric onto the states with the measured
/// output y (that at the switch where the plant has sensors for it, else the continuous one):
///
///   x̂ ← x̂ + P_q⁻¹ H_qᵀ (H_q P_q⁻¹ H_qᵀ)⁻¹ (y − H_q x̂)
///
/// so that (x − x̂)ᵀ P_q (x − x̂) does not grow. Outputs that are not known correct nothing. Those of
/// continuous sensors are held between their stamps. The innovation of angular outputs is wrapped.
class SwitchedObserver final : public PlantObserver {
 public:
  /// @throws std::invalid_argument as check_switched_gains(), make_metric_gains() and
  /// make_projections().
  SwitchedObserver(const ObserverContext& context, SwitchedGains gains);

  /// Of each mode q: L_c/q/sensor, L_d/q/sensor, metric/q and projection/q.
  LawGains gains() const override;

 protected:
  bool flow_is_affine() const override;
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;
  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;

 private:
  /// Of the largest workspace that a gain of metrics needs.
  Eigen::Index metric_workspace() const;
  /// correction ← L_d(τ) (y_d − H x̂) with the gain of a metric, where all of y_d is known.
  void correct_by_metric(const Held& held, const JumpOutputs& outputs, const double* state,
                         double* correction, double* workspace) const;
  /// x̂ projected onto the outputs known
  void project(const Held& held, const JumpOutputs& outputs, double* state,
               double* workspace) const;
  /// correction ← L_d(τ) (y_d − H x̂)
  void compute_correction(const Held& held, const JumpOutputs& outputs, const double* state,
                          double* correction, double* workspace) const;
  bool all_known(const JumpOutputs& outputs) const;

  SwitchedGains gains_;
  std::vector<MetricGain> metric_gains_;
  std::vector<Projection> projections_;
  VectorSlot correction_ = scratch(n());
  VectorSlot innovation_ = scratch(plant().max_outputs());
  VectorSlot innovations_ = scratch(std::max(plant().outputs(SensorTiming::kAtJumps),
                                             plant().outputs(SensorTiming::kContinuous)));
  VectorSlot L_d_ = scratch(n() * plant().max_outputs());  ///< row by row
  VectorSlot metric_L_d_ =
      scratch(metric_gains_.empty() ? 0 : n() * plant().outputs(SensorTiming::kAtJumps));
  VectorSlot metric_workspace_ = scratch(metric_workspace());
};

}  // namespace sampled_data_observers
