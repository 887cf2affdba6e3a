#pragma once

#include <Eigen/Core>
#include <vector>

namespace sampled_data_observers {

/// An upper bound on ‖Y e^{Aτ} X‖₂ as a function of τ in [0, T]: the norms at equidistant times,
/// between which a matrix is at most h²/8 max ‖d²/dτ² (Y e^{Aτ} X)‖ away from linear interpolation.
/// Up to rounding it is never less than the norm.
///
/// at() allocates nothing and throws nothing.
class ExponentialNorm {
 public:
  /// @param T  [s], > 0
  ExponentialNorm(const Eigen::MatrixXd& Y, const Eigen::MatrixXd& A, const Eigen::MatrixXd& X,
                  double T);

  /// @param tau  [s], taken as the nearer end where it is outside [0, T]
  double at(double tau) const;

 private:
  double step_ = 0.0;
  std::vector<double> norms_;   ///< at 0, step, 2 step, …
  std::vector<double> excess_;  ///< of what lies between two of them
};

}  // namespace sampled_data_observers
