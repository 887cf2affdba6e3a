#pragma once

#include <Eigen/Core>
#include <vector>

#include "observer/high_gain_observer.h"

namespace sampled_data_observers {

/// Example 4.2, for a flow and outputs that are affine and observable together, in each mode:
///
///   ẋ̂ = A x̂ + B u + b + L_c (y_c − H x̂),  eig(A − L_c H) = ℓ eig(𝐀 − 𝐊 𝐇)
///
/// H (m x n) holds the continuous outputs of all sensors; L_c (n x m) is that of high_gain().
/// The flow is exact, but for angular outputs.
class LinearHighGainObserver final : public HighGainObserver {
 public:
  /// @param settings  K: per continuous output the d_i numbers of K_i, the last one belonging to
  ///                  the output itself: the eigenvalues are the zeros of
  ///                  s^d + k_d s^(d−1) + … + k_1
  /// @throws std::invalid_argument for a plant that is not affine or not observable, and a K that
  /// does not fit.
  LinearHighGainObserver(const ObserverContext& context, const HighGainSettings& settings);

  /// Per mode, per sensor: n x m_i
  const std::vector<std::vector<Eigen::MatrixXd>>& L_c() const { return L_c_; }

 protected:
  bool flow_is_affine() const override;
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;

 private:
  std::vector<std::vector<Eigen::MatrixXd>> L_c_;
};

}  // namespace sampled_data_observers
