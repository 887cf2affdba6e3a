#pragma once

#include <Eigen/Core>
#include <vector>

#include "observer/intersample_injection_observer.h"

namespace sampled_data_observers {

/// The Luenberger observer with held innovation (etienne2019, (2)), for several sensors:
///
///   ẋ̂ = f(x̂, u) + Σ L_i (h_i(x̂(t_k)) − y_i(t_k))    from a sample at t_k of sensor i to its next
///
/// The innovation has the sign of that paper, estimate minus measurement: its gains make A + L C
/// stable, not A − L C. So it is the intersample injection with the gain −L_i and H_i = 0. L_i is
/// n x m_i. Before the first sample of a sensor nothing is injected for it.
class SampleAndHoldObserver : public IntersampleInjectionObserver {
 public:
  /// @param L  one gain per sensor of the plant, in its order, in the paper's sign
  /// @throws std::invalid_argument when a size does not fit the plant.
  SampleAndHoldObserver(const ObserverContext& context, const std::vector<Eigen::MatrixXd>& L);

  /// L_i in the paper's sign. H_i = 0 is none of them.
  LawGains gains() const override;
};

}  // namespace sampled_data_observers
