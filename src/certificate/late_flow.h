#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "certificate/timer_dependent_conditions.h"

namespace sampled_data_observers {

/// How much V = eᵀ P(τ) e of a TimerDependentFunction grows at most where timers are beyond their
/// longest times, at which they stand still in P. The conditions of the flow say nothing of that:
/// they count on a P that falls. By two norms, of which either holds:
/// - that of P(τ): d/dt √V <= c √V + |N|_P |w|, with c from the flow conditions without the slopes
/// of
///   the late timers;
/// - one in which the flow grows little (FlowGrowth), |e|_Q: the same with its own c, at the price
///   of what V and |e|_Q² differ by.
class LateFlow {
 public:
  /// @param P  at each node
  /// @param disturbance  |w| <= this
  /// @param horizon      the time that matters [s]
  LateFlow(const TimerDependentFunction& function, const NamedMatrices& values,
           const std::vector<Eigen::MatrixXd>& P, double disturbance, double horizon);

  /// √V after `duration` [s] with these timers late, a bit for each, from this √V on.
  double flowed(std::size_t late, double root, double duration) const;

  /// The same by |e|_Q, whichever timers are late.
  /// @param weight_rounding  by which weights may be off
  double flowed_in_Q(const TensorGrid::Interpolation& from, double root, double duration,
                     const TensorGrid::Interpolation& to, double weight_rounding) const;

 private:
  struct Growth {
    double rate = 0.0;
    double push = 0.0;
  };
  Growth growth_on_face(const TimerDependentFunction& function,
                        const std::vector<Eigen::MatrixXd>& F,
                        const std::vector<Eigen::MatrixXd>& P, std::size_t late,
                        double disturbance) const;

  std::vector<Growth> growth_;  ///< of each set of late timers
  Growth in_Q_;
  std::vector<double> into_Q_;  ///< β of each node: Q <= β P_k
  std::vector<double> from_Q_;  ///< η: P_k <= η Q
};

}  // namespace sampled_data_observers
