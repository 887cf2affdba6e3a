#pragma once

#include <Eigen/Core>
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
  HighGainObserver(const ObserverContext& context, Saturation saturation, Eigen::Index flowing = 0);

  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;

  const Saturation& saturation() const { return saturation_; }

  /// To be called by the constructor of each form for what gains() has beside the saturations.
  LawGains& listed() { return listed_; }

  /// @throws std::invalid_argument for other than one continuous output.
  void require_one_output() const;

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
  VectorSlot innovations_ = scratch(plant().outputs(SensorTiming::kContinuous));
};

}  // namespace sampled_data_observers
