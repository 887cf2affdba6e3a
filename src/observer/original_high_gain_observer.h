#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "observer/damped_inverse.h"
#include "observer/high_gain_observer.h"

namespace sampled_data_observers {

/// Example 4.3 in the plant's own coordinates, d = n in all:
///
///   ẋ̂ = f(sat(x̂), u) + (∂T/∂x(sat(x̂)))⁻¹ ℓ 𝓛(ℓ) K (y_c − h(x̂))
///
/// with a DampedInverse, and x̂ brought back to its bounds, sat(x̂), after each step of the
/// integration. The Jacobian is taken by central differences.
class OriginalHighGainObserver final : public HighGainObserver {
 public:
  /// @param settings  K: n numbers in all, as for TransformedHighGainObserver
  /// @param T         per mode: n to n
  /// @param damping   δ of the DampedInverse
  /// @throws std::invalid_argument as TransformedHighGainObserver, and, without damping, where
  /// ∂T/∂x is singular at the initial estimate.
  OriginalHighGainObserver(const ObserverContext& context, const HighGainSettings& settings,
                           std::vector<std::shared_ptr<const VectorMap>> T, double damping);

  /// Per mode
  const std::vector<std::shared_ptr<const VectorMap>>& T() const { return T_; }

  LawGains gains() const override;

 protected:
  bool flow_is_affine() const override { return false; }
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;
  /// What has no finite value is left as it is, and the flow held.
  void confine(double* s) const override;

 private:
  std::vector<std::shared_ptr<const VectorMap>> T_;
  std::vector<std::vector<Eigen::MatrixXd>> gain_;  ///< per mode, per sensor: of ℓ 𝓛(ℓ) K
  double damping_;
  DampedInverse inverse_;
  VectorSlot x_ = scratch(n());  ///< sat(x̂)
  VectorSlot J_ = scratch(n() * n());
  VectorSlot differences_ = scratch(3 * n());
  VectorSlot solving_ = scratch(inverse_.workspace_size());
  VectorSlot correction_ = scratch(n());
};

}  // namespace sampled_data_observers
