#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "observer/high_gain_observer.h"

namespace sampled_data_observers {

/// Example 4.3: with z = T(x) = (h, L_f h, …, L_f^(d−1) h)(x),
///
///   ż = A z + B Φ(T(x̂), x̂, u) + ℓ 𝓛(ℓ) K (y_c − z_1),  x̂ = sat(Θ(z)),  z⁺ = T(sat(g(x̂)))
///
/// A (d x d) shifts up, B = (0 … 0 1), 𝓛(ℓ) = diag(1, ℓ, …, ℓ^(d−1)). Φ = L_f^d h is taken at x̂,
/// not at z, so that the saturations bound it, as they must. The maps and K of a switched plant
/// are those of its mode, and z⁺ is taken by T of the next one (51). With several continuous
/// outputs z has such a chain for each, with an L_f^d_j h_j and a K_j of its own, one behind the
/// other.
class TransformedHighGainObserver final : public HighGainObserver {
 public:
  struct Maps {
    std::shared_ptr<const VectorMap> T;      ///< x to z: n to d
    std::shared_ptr<const VectorMap> Phi;    ///< (T(x), x), u to L_f^d h: d + n to m
    std::shared_ptr<const VectorMap> Theta;  ///< z to x: d to n; Θ(T(x)) = x
  };

  /// @param settings  K: per output d numbers, the same d in each mode: the eigenvalues of
  ///                  A − K H, H = (1 0 … 0), are the zeros of s^d + k_1 s^(d−1) + … + k_d
  /// @param maps      per mode
  /// @throws std::invalid_argument for maps that do not fit, a K that does not make A − K H
  /// Hurwitz.
  TransformedHighGainObserver(const ObserverContext& context, const HighGainSettings& settings,
                              std::vector<Maps> maps);

  /// Per mode
  const std::vector<Maps>& maps() const { return maps_; }

  void start_from(const double* estimate, double* state) const override;
  void keep_mode(std::size_t mode, double* state) const override;

 protected:
  bool flow_is_affine() const override { return false; }
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;
  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;
  void complete(const Held& held, double* state, double* workspace) const override;

 private:
  std::vector<Maps> maps_;
  OutputChains chains_;
  std::vector<Eigen::MatrixXd> gain_;  ///< per mode: ℓ 𝓛(ℓ) K
  VectorSlot z_ = flowing(chains_.entries());
  VectorSlot argument_ = scratch(z_.size() + n());  ///< (T(x), x)
  VectorSlot of_outputs_ = scratch(plant().outputs(SensorTiming::kContinuous));
};

}  // namespace sampled_data_observers
