#pragma once

#include <Eigen/Core>
#include <memory>

#include "observer/high_gain_observer.h"

namespace sampled_data_observers {

/// Example 4.3 in the plant's own coordinates, for one continuous output and d = n:
///
///   ẋ̂ = f(sat(x̂), u) + (∂T/∂x(x̂))⁻¹ ℓ 𝓛(ℓ) K (y_c − h(x̂))
///
/// The Jacobian is taken by central differences. Where it is singular the derivative is NaN.
class OriginalHighGainObserver final : public HighGainObserver {
 public:
  /// @param T  n to n
  /// @param K  n numbers, as for TransformedHighGainObserver
  /// @throws std::invalid_argument as TransformedHighGainObserver, and where ∂T/∂x is singular at
  /// the initial estimate.
  OriginalHighGainObserver(const ObserverContext& context, Saturation saturation, double ell,
                           const Eigen::VectorXd& K, std::shared_ptr<const VectorMap> T);

 protected:
  bool flow_is_affine() const override { return false; }
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;

 private:
  std::shared_ptr<const VectorMap> T_;
  Eigen::VectorXd gain_;         ///< ℓ 𝓛(ℓ) K
  VectorSlot x_ = scratch(n());  ///< sat(x̂)
  VectorSlot J_ = scratch(n() * n());
  VectorSlot differences_ = scratch(3 * n());
  VectorSlot correction_ = scratch(n());
};

}  // namespace sampled_data_observers
