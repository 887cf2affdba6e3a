#pragma once

#include <Eigen/Core>
#include <vector>

#include "certificate/flow_growth.h"

namespace sampled_data_observers {

/// An upper bound on ‖Y e^{Aτ} X‖₂ as a function of τ >= 0.
///
/// Up to T it interpolates between the norms at equidistant times: between them the matrix is at
/// most h²/8 max ‖d²/dτ² (Y e^{Aτ} X)‖ away from linear interpolation, and no larger than what the
/// growth of the flow (FlowGrowth) from the time before allows, which is less where h is long for
/// fast modes. After T it grows as the flow does. A share of 1e-9 covers rounding.
///
/// at() allocates nothing and throws nothing; it is infinite where no bound is known.
class ExponentialNorm {
 public:
  /// @param T  [s], > 0
  /// @param growth  of A
  ExponentialNorm(const Eigen::MatrixXd& Y, const Eigen::MatrixXd& A, const Eigen::MatrixXd& X,
                  double T, const FlowGrowth& growth);

  /// @param tau  [s], >= 0
  double at(double tau) const;

 private:
  double T_ = 0.0;
  double step_ = 0.0;
  double rate_ = 0.0;
  std::vector<double> norms_;   ///< at 0, step, 2 step, …
  std::vector<double> excess_;  ///< of what lies between two of them
  std::vector<double> start_;   ///< ‖Y W⁻¹‖ ‖W e^{Aτ} X‖ at 0, step, 2 step, …
};

}  // namespace sampled_data_observers
