#pragma once

#include <Eigen/Core>
#include <memory>

#include "observer/high_gain_observer.h"

namespace sampled_data_observers {

/// Example 4.3, for one continuous output: with z = T(x) = (h, L_f h, …, L_f^(d−1) h)(x),
///
///   ż = A z + B Φ(T(x̂), x̂, u) + ℓ 𝓛(ℓ) K (y_c − z_1),  x̂ = sat(Θ(z)),  z⁺ = T(sat(g(x̂)))
///
/// A (d x d) shifts up, B = (0 … 0 1), 𝓛(ℓ) = diag(1, ℓ, …, ℓ^(d−1)). Φ = L_f^d h is taken at x̂,
/// not at z, so that the saturations bound it, as they must.
class TransformedHighGainObserver final : public HighGainObserver {
 public:
  struct Maps {
    std::shared_ptr<const VectorMap> T;      ///< x to z: n to d
    std::shared_ptr<const VectorMap> Phi;    ///< (T(x), x), u to L_f^d h: d + n to 1
    std::shared_ptr<const VectorMap> Theta;  ///< z to x: d to n; Θ(T(x)) = x
  };

  /// @param K  d numbers: the eigenvalues of A − K H, H = (1 0 … 0), are the zeros of
  ///           s^d + k_1 s^(d−1) + … + k_d
  /// @throws std::invalid_argument for maps that do not fit, a K that does not make A − K H
  /// Hurwitz, and other than one continuous output.
  TransformedHighGainObserver(const ObserverContext& context, Saturation saturation, double ell,
                              const Eigen::VectorXd& K, Maps maps);

  void start_from(const double* estimate, double* state) const override;

 protected:
  bool flow_is_affine() const override { return false; }
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;
  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;
  void complete(const Held& held, double* state, double* workspace) const override;

 private:
  Maps maps_;
  Eigen::VectorXd gain_;  ///< ℓ 𝓛(ℓ) K
  VectorSlot z_ = flowing(gain_.size());
  VectorSlot argument_ = scratch(gain_.size() + n());  ///< (T(x), x)
};

}  // namespace sampled_data_observers
