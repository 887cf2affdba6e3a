#pragma once

#include <algorithm>
#include <vector>

#include "linear_algebra/joseph_update.h"
#include "observer/kalman_jacobians.h"
#include "observer/kalman_matrices.h"
#include "plant/covariance_flow.h"
#include "plant/covariance_step.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The Kalman filter of a plant with jumps, sporadic samples and outputs at jumps (bernard2022,
/// (40), in the standard form, where a jump's gain is computed from the time that passed before
/// that jump):
///
///   ẋ̂ = A x̂ + B u + b,  Ṗ = A P + P Aᵀ + Q       between events, both exactly
///   K = P Cᵀ (C P Cᵀ + R)⁻¹,  x̂⁺ = x̂ + K (y − C x̂)
///   P⁺ = (I − K C) P (I − K C)ᵀ + K R Kᵀ           at a sample, and first at a jump with y_d
///   x̂⁺ = A_d x̂ + b_d,  P⁺ = A_d P A_dᵀ + Q_d      at a jump
///
/// In a mode without jump map, A_d is the identity and b_d is 0. A, C and A_d may differ from mode
/// to mode. Innovations of angular outputs are wrapped.
///
/// Where the stamps of jumps are off by ε, of mean 0 and standard deviation σ, which is independent
/// from jump to jump and of all else, the error after a jump is A_d e + s ε to first order, with
/// the saltation vector s = f⁺(g(x̂)) − A_d f(x̂), f the field of the mode before the jump and f⁺
/// that of the mode after it, both at the input held:
///
///   P⁺ = A_d P A_dᵀ + Q_d + σ² s sᵀ
///
/// Outputs measured at the jump are those of the plant just before it, C (x − f ε) at the stamp:
/// they correct x̂ and, beside it, ε, whose estimate ε̂ then moves x̂⁺ by s ε̂.
///
/// Where a map of the plant is not affine, the filter is the extended one: A, C and A_d are the
/// map's Jacobian at the estimate, x̂ flows and jumps by the map itself, and y is compared with
/// h(x̂, u). Unless all flows are affine, x̂ is integrated by Runge–Kutta steps, and P with it, by
/// covariance_step() with A in the middle of each, at the mean of x̂ before and after it.
/// Where states are of unit norm, P is projected with them, by the Jacobian of the normalization:
/// it has no variance along such a group. An update by outputs that are not affine may be iterated
/// (the Gauss–Newton method for the most probable state): each iteration linearizes h at the result
/// of the one before.
///
/// Each update is made output by output, after a transformation in which their noises are
/// independent and of variance 1. That gives the same, and needs no inverse that might fail.
class HybridKalmanFilter : public PlantObserver {
 public:
  /// @throws std::invalid_argument, std::length_error as kalman_matrices() and KalmanJacobians.
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
  bool flow_is_affine() const override { return !covariance_flows_.empty(); }
  void flow_constants(Duration duration, const Held& held, double* state,
                      double* workspace) const override;
  void step_constants(Duration duration, const Held& held, const double* before, double* after,
                      double* state, double* workspace) const override;

 private:
  void add_covariance_of_stamp(const double* C, Eigen::Index m, const double* state, double* S,
                               double* workspace) const;
  void correct(std::size_t sensor, const double* y, const Held& held, double* state,
               double* workspace) const;
  void jump_of_certain_stamp(const Held& held, const JumpOutputs& outputs, double* state,
                             double* workspace) const;
  void jump_of_uncertain_stamp(const Held& held, std::size_t next, const JumpOutputs& outputs,
                               double* state, double* workspace) const;
  void normalized_innovation(std::size_t sensor, const double* y, const Held& held,
                             const double* state, double* workspace) const;
  void take_noise(std::size_t sensor, const double* y, double* workspace) const;
  const double* noise_root(std::size_t sensor, const double* workspace) const;
  bool is_affine(std::size_t sensor, const Held& held) const;
  const double* output_rows(std::size_t sensor, const Held& held, const double* x,
                            double* workspace) const;
  const double* jump_matrix(const Held& held, const double* x, double* workspace) const;
  void correct_iteratively(std::size_t sensor, const double* y, const Held& held, double* state,
                           double* workspace) const;
  void normalize(double* state) const;
  void update(const double* rows, Eigen::Index outputs, Eigen::Index size, double* P,
              double* workspace) const;
  /// Number of variables that are corrected at jumps: x, and ε where stamps are uncertain.
  Eigen::Index variables() const { return n() + (matrices_.stamp_deviation > 0.0 ? 1 : 0); }
  /// `entries`, or none where stamps are certain.
  Eigen::Index where_uncertain(Eigen::Index entries) const {
    return matrices_.stamp_deviation > 0.0 ? entries : 0;
  }

  /// `entries`, or none where the plant is affine.
  Eigen::Index where_nonlinear(Eigen::Index entries) const {
    return plant().is_affine() ? 0 : entries;
  }
  /// `entries`, or none where the rows of all outputs are known beforehand.
  Eigen::Index where_rows_vary(Eigen::Index entries) const {
    return takes_covariances(matrices_) ? entries : where_nonlinear(entries);
  }
  /// `entries`, or none where updates are not iterated.
  Eigen::Index where_iterated(Eigen::Index entries) const { return iterations_ > 1 ? entries : 0; }

  KalmanMatrices matrices_;
  KalmanJacobians jacobians_;
  int iterations_;
  std::vector<CovarianceFlow> covariance_flows_;  ///< one per mode; none unless all are affine

  VectorSlot P_ = constants(n() * n());
  VectorSlot innovation_ = scratch(plant().max_outputs());
  VectorSlot correction_ = scratch(variables());
  VectorSlot updating_ = scratch(joseph_update_scratch(variables()));
  VectorSlot flown_ = scratch(CovarianceFlow::scratch_size(n()));
  VectorSlot S_ = scratch(plant().max_outputs() * plant().max_outputs());
  VectorSlot PC_ = scratch(n() * plant().max_outputs());
  // Of a plant that is not affine.
  VectorSlot jacobian_ = scratch(where_rows_vary(n() * std::max(n(), plant().max_outputs())));
  VectorSlot output_rows_ = scratch(where_rows_vary(n() * plant().max_outputs()));
  VectorSlot noise_root_ = scratch(where_rows_vary(plant().max_outputs() * plant().max_outputs()));
  VectorSlot differentiating_ = scratch(jacobians_.workspace_size());
  VectorSlot midpoint_ = scratch(where_nonlinear(n()));
  VectorSlot stepping_ = scratch(where_nonlinear(covariance_step_workspace(n())));
  VectorSlot x_before_ = scratch(where_iterated(n()));
  VectorSlot P_before_ = scratch(where_iterated(n() * n()));
  VectorSlot moved_ = scratch(where_iterated(n()));
  // Of a jump whose stamp is uncertain.
  VectorSlot joint_ = scratch(where_uncertain(variables() * variables()));  ///< cov (x, ε)
  VectorSlot rows_ = scratch(where_uncertain(variables() * plant().max_outputs()));
  VectorSlot transition_ = scratch(where_uncertain(n() * variables()));  ///< (A_d, s)
  VectorSlot propagated_ = scratch(where_uncertain(n() * variables()));
  VectorSlot field_before_ = scratch(where_uncertain(n()));
  VectorSlot field_after_ = scratch(where_uncertain(n()));
};

}  // namespace sampled_data_observers
