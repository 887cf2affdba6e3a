#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "observer/saturation.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// High-gain observers (bernard2022, section 4.2): the flow is corrected by the innovation of the
/// continuous outputs y_c with a gain that grows with powers of ℓ, and jumps are copied from the
/// plant, x̂⁺ = sat(g(x̂)) (21). The outputs are held between their stamps; before each of them came
/// once, at the start and after each jump, the flow is the plant's. The innovation of angular
/// outputs is wrapped.
///
/// The plant has one mode. There are three forms, one class each.
class HighGainObserver : public PlantObserver {
 public:
  /// ell, K (K/1, K/2, … where there are several), saturations/state, and T, Phi and Theta, which
  /// are formulas.
  LawGains gains() const override { return listed_; }
  bool is_saturated(const double* state) const override { return saturation_.is_active(state); }

 protected:
  HighGainObserver(const ObserverContext& context, const Extras& extras, Saturation saturation);

  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;

  const Saturation& saturation() const { return saturation_; }

  /// To be called by the constructor of each form for what gains() has beside the saturations.
  LawGains& listed() { return listed_; }

  /// To be called at the end of the constructor of a form that may be undefined at some estimates.
  /// @throws std::invalid_argument where it is at the initial one.
  void check_start() const;

 private:
  Saturation saturation_;
  LawGains listed_;
};

/// Example 4.2, for a flow and outputs that are affine and observable together:
///
///   ẋ̂ = A x̂ + B u + b + L_c (y_c − H x̂),  eig(A − L_c H) = ℓ eig(𝐀 − 𝐊 𝐇)
///
/// H (m x n) holds the continuous outputs of all sensors; L_c (n x m) is that of high_gain().
/// The flow is exact, but for angular outputs.
class LinearHighGainObserver final : public HighGainObserver {
 public:
  /// @param ell  ℓ > 0
  /// @param K    per continuous output the d_i numbers of K_i, the last one belonging to the output
  ///             itself: the eigenvalues are the zeros of s^d + k_d s^(d−1) + … + k_1
  /// @throws std::invalid_argument for a plant that is not affine or not observable, and a K that
  /// does not fit.
  LinearHighGainObserver(const ObserverContext& context, Saturation saturation, double ell,
                         const std::vector<Eigen::VectorXd>& K);

  /// n x m
  const Eigen::MatrixXd& L_c() const { return L_c_; }

 protected:
  bool flow_is_affine() const override;
  void derivative(const Held& held, const double* s, double* ds, double* workspace) const override;

 private:
  Eigen::MatrixXd L_c_;
};

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
};

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
  /// J (n x n, column-major) ← ∂T/∂x at x; `scratch`: 3 n entries
  void differentiate(const double* x, const double* u, double* J, double* scratch) const;

  std::shared_ptr<const VectorMap> T_;
  Eigen::VectorXd gain_;  ///< ℓ 𝓛(ℓ) K
};

}  // namespace sampled_data_observers
