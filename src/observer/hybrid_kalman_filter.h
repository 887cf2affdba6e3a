#pragma once

#include <vector>

#include "observer/kalman_matrices.h"
#include "plant/covariance_flow.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The Kalman filter of an affine plant with jumps, sporadic samples and outputs at jumps
/// (bernard2022, (40), in the standard form, where a jump's gain is computed from the time that
/// passed before that jump):
///
///   ẋ̂ = A x̂ + B u + b,  Ṗ = A P + P Aᵀ + Q       between events, both exactly
///   K = P Cᵀ (C P Cᵀ + R)⁻¹,  x̂⁺ = x̂ + K (y − C x̂)
///   P⁺ = (I − K C) P (I − K C)ᵀ + K R Kᵀ           at a sample, and first at a jump with y_d
///   x̂⁺ = A_d x̂ + b_d,  P⁺ = A_d P A_dᵀ + Q_d      at a jump
///
/// In a mode without jump map, A_d is the identity and b_d is 0. A, C and A_d may differ from mode
/// to mode. Innovations of angular outputs are wrapped.
///
/// Each update is made output by output, after a transformation in which their noises are
/// independent and of variance 1. That gives the same, and needs no inverse that might fail.
class HybridKalmanFilter : public PlantObserver {
 public:
  /// @throws std::invalid_argument as kalman_matrices().
  HybridKalmanFilter(const ObserverContext& context, const KalmanCovariances& covariances);

  /// The covariances that it is tuned by.
  LawGains gains() const override;
  /// P, n x n.
  const double* covariance(const double* state) const override { return P_.of(state); }
  void start_from(const double* estimate, double* state) const override;
  double mahalanobis_distance(const Event& sample, const double* state,
                              double* workspace) const override;

 protected:
  void sample(std::size_t sensor, const double* y, const Held& held, double* state,
              double* workspace) const override;
  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;
  void flow_constants(Duration duration, const Held& held, double* state,
                      double* workspace) const override;

 private:
  void correct(std::size_t sensor, const double* y, const Held& held, double* state,
               double* workspace) const;

  KalmanMatrices matrices_;
  std::vector<CovarianceFlow> covariance_flows_;  ///< one per mode

  VectorSlot P_ = constants(n() * n());
  VectorSlot innovation_ = scratch(plant().max_outputs());
  VectorSlot correction_ = scratch(n());
  VectorSlot gain_ = scratch(n());
  VectorSlot column_ = scratch(n());  ///< P c
  VectorSlot rest_ = scratch(n());    ///< (I − K c) P c
  VectorSlot flown_ = scratch(n() * n());
  VectorSlot S_ = scratch(plant().max_outputs() * plant().max_outputs());
  VectorSlot PC_ = scratch(n() * plant().max_outputs());
};

}  // namespace sampled_data_observers
