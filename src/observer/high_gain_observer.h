#pragma once

#include <Eigen/Core>
#include <string>
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
  /// @param K     per continuous output its gains before scaling
  /// @param maps  the names of what a form is given by formulas
  /// @throws std::invalid_argument for saturations that do not fit, and a plant with several modes
  /// or without a sensor.
  HighGainObserver(const ObserverContext& context, Saturation saturation, double ell,
                   const std::vector<Eigen::VectorXd>& K, const std::vector<std::string>& maps = {},
                   Eigen::Index flowing = 0);

  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;

  const Saturation& saturation() const { return saturation_; }

  /// @throws std::invalid_argument for other than one continuous output.
  void require_one_output() const;

  /// To be called at the end of the constructor of a form that may be undefined at some estimates.
  /// @throws std::invalid_argument where it is at the initial one.
  void check_start() const;

 private:
  Saturation saturation_;
  LawGains listed_;
};

}  // namespace sampled_data_observers
