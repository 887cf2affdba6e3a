#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "linear_algebra/joseph_update.h"
#include "observer/kalman_matrices.h"
#include "plant/covariance_flow.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// The HybridKalmanFilter with the unscented transformation (sigma_points.h) in place of Jacobians:
///
/// - In flow, each step of the integration carries x̂ and the points of P + h/2 Q along; x̂ becomes
///   their mean, P their covariance and h/2 Q. Where the flows of all modes are affine, x̂ and P
///   flow exactly.
/// - At a sample, y is compared with the mean of h over the points. Written with ξ, x = x̂ + Λ ξ,
///   cov ξ = I, what the points say is y = ȳ + O ξ + v, with O = (o_1 … o_n), v of the covariance
///   R + Σ e_i e_iᵀ and independent of ξ: the update of ξ is that of a linear filter, in Joseph's
///   form, and Λ carries it over to x̂ and P. Where h is affine it is the linear filter's.
/// - At a jump, points are carried through g. Where its stamp is off by ε, they are points of
///   (x, ε), with y_d = h(x − f ε) and x⁺ = g(x − f ε) + f⁺ ε, f and f⁺ at the mean before and
///   after it.
///
/// Differences of angular outputs are wrapped. Points are brought to unit norm where states have
/// it, and so are x̂ and P.
class UnscentedKalmanFilter : public PlantObserver {
 public:
  /// @throws std::invalid_argument as kalman_matrices(), and for iterations > 1.
  UnscentedKalmanFilter(const ObserverContext& context, const KalmanCovariances& covariances);

  LawGains gains() const override;
  /// P, n x n.
  const double* covariance(const double* state) const override { return P_.of(state); }
  void start_from(const double* estimate, double* state) const override;
  double mahalanobis_distance(const Event& measured, const double* state,
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
  class Field;

  /// x, or (x, ε) at a jump whose stamp is uncertain: its mean, and Λ of its covariance.
  struct Variables {
    Eigen::Index size = 0;
    double* mean = nullptr;
    double* factor = nullptr;
    const double* speed = nullptr;  ///< f, where ε is among them; else null
  };

  Variables variables(const double* state, bool with_stamp, double* workspace) const;
  void to_stamp(const Variables& of, double* point) const;
  void measure(std::size_t sensor, const double* y, const Held& held, const Variables& of,
               double* workspace) const;
  void correct(std::size_t sensor, const double* y, const Held& held, const Variables& of,
               double* workspace) const;
  void correct_linearly(std::size_t sensor, const double* y, const Held& held, double* state,
                        double* workspace) const;
  void normalize(double* state) const;
  bool has_uncertain_stamps() const { return matrices_.stamp_deviation > 0.0; }
  /// Number of variables at jumps.
  Eigen::Index most_variables() const { return n() + (has_uncertain_stamps() ? 1 : 0); }
  Eigen::Index most_rows() const { return std::max(n(), plant().max_outputs()); }

  KalmanMatrices matrices_;
  std::vector<CovarianceFlow> covariance_flows_;  ///< one per mode; none unless all are affine
  std::unique_ptr<const RungeKuttaFlow> points_flow_;

  VectorSlot P_ = constants(n() * n());
  VectorSlot mean_ = scratch(most_variables());
  VectorSlot factor_ = scratch(most_variables() * most_variables());
  VectorSlot covariance_ = scratch(most_variables() * most_variables());  ///< of ξ, then of (x, ε)
  VectorSlot product_ = scratch(most_variables() * most_variables());
  VectorSlot point_ = scratch(most_variables());
  VectorSlot spread_ = scratch(2 * most_variables() * most_rows());
  VectorSlot centre_ = scratch(most_rows());  ///< T(x̂)
  VectorSlot rows_ = scratch(most_variables() * plant().max_outputs());
  VectorSlot noise_ = scratch(plant().max_outputs() * plant().max_outputs());
  VectorSlot innovation_ = scratch(plant().max_outputs());
  VectorSlot correction_ = scratch(most_variables());
  VectorSlot updating_ = scratch(joseph_update_scratch(most_variables()));
  VectorSlot flown_ = scratch(CovarianceFlow::scratch_size(n()));
  VectorSlot speed_before_ = scratch(n());
  VectorSlot speed_after_ = scratch(n());
};

}  // namespace sampled_data_observers
