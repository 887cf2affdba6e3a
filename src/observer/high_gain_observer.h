#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "observer/high_gain_settings.h"
#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

/// High-gain observers (bernard2022, section 4.2): the flow is corrected by the innovation of the
/// continuous outputs y_c with a gain that grows with powers of ℓ, and jumps are copied from the
/// plant, x̂⁺ = sat(g(x̂)) (21). The outputs are held between their stamps; before each of them came
/// once, at the start and after each jump, the flow is the plant's. The innovation of angular
/// outputs is wrapped.
///
/// A switched plant has its gains mode by mode (example 7.3). There are three forms, one class
/// each.
class HighGainObserver : public PlantObserver {
 public:
  LawGains gains() const override { return listed_; }
  bool is_saturated(const double* state) const override { return saturation().is_active(state); }

  const HighGainSettings& settings() const { return settings_; }
  const Saturation& saturation() const { return settings_.saturation; }

 protected:
  /// @param maps     the names of what a form is given by formulas
  /// @param flowing  number of states that flow beside x̂
  /// @throws std::invalid_argument as check_settings()
  HighGainObserver(const ObserverContext& context, const HighGainSettings& settings,
                   const std::vector<std::string>& maps = {}, Eigen::Index flowing = 0);

  void jump(const Held& held, std::size_t next, const JumpOutputs& outputs, double* state,
            double* workspace) const override;

  /// To be called at the end of the constructor of a form that may be undefined at some estimates.
  /// @throws std::invalid_argument where it is at the initial one.
  void check_start() const;

 private:
  HighGainSettings settings_;
  LawGains listed_;
};

}  // namespace sampled_data_observers
