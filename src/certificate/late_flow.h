#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "certificate/timer_dependent_conditions.h"

namespace sampled_data_observers {

/// How much V = eᵀ P(τ) e of a TimerDependentFunction grows at most where timers are beyond their
/// longest times, at which they stand still in P. The conditions of the flow say nothing of that:
/// they count on a P that falls. By several norms, which all hold:
/// - that of P(τ): d/dt √V <= c √V + |N|_P |w|, with c from the flow conditions without the slopes
///   of the late timers;
/// - those with a constant Q, |e|_Q, in which the flow grows little (FlowGrowth), or P is that just
///   after events: the same with their own c, at the price of what V and |e|_Q² differ by. The
///   least counts.
class LateFlow {
 public:
  /// @param P  at each node
  /// @param disturbance  |w| <= this
  /// @param horizon      the time that matters [s]
  LateFlow(const TimerDependentFunction& function, const NamedMatrices& values,
           const std::vector<Eigen::MatrixXd>& P, double disturbance, double horizon);

  /// √V after `duration` [s] with these timers late, a bit for each, from this √V on.
  double flowed(std::size_t late, double root, double duration) const;

  /// The same by the least |e|_Q, whichever timers are late.
  /// @param weight_rounding  by which weights may be off
  double flowed_in_Q(const TensorGrid::Interpolation& from, double root, double duration,
                     const TensorGrid::Interpolation& to, double weight_rounding) const;

  /// d/dt √V <= rate √V + push
  struct Growth {
    double rate = 0.0;  ///< 1/s
    double push = 0.0;
  };
  /// That of the norm of P(τ) with these timers late.
  const Growth& growth(std::size_t late) const { return growth_[late]; }
  /// The same for any flows in the convex hull of matrices F; `late` may be none.
  static Growth growth_on_face(const TimerDependentFunction& function,
                               const std::vector<Eigen::MatrixXd>& F,
                               const std::vector<Eigen::MatrixXd>& P, std::size_t late,
                               double disturbance);

  /// The same of |e|_Q.
  static Growth growth_in(const ErrorSystem& system, const std::vector<Eigen::MatrixXd>& F,
                          const Eigen::MatrixXd& Q, double disturbance);

 private:
  struct Norm {
    Growth growth;
    std::vector<double> into;  ///< β of each node: Q <= β P_k
    std::vector<double> out;   ///< η: P_k <= η Q
  };
  void add_norm(const ErrorSystem& system, const std::vector<Eigen::MatrixXd>& F,
                const std::vector<Eigen::MatrixXd>& P, const Eigen::MatrixXd& Q,
                double disturbance);

  std::vector<Growth> growth_;  ///< of each set of late timers
  std::vector<Norm> norms_;
};

}  // namespace sampled_data_observers
