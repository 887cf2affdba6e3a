#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "observer/gate_state.h"
#include "observer/law_decorator.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Which samples of a sensor are outliers, and what to do when there are nothing but outliers.
struct Gate {
  enum class Recovery : std::uint8_t {
    kAccept,  ///< samples are used again
    kReset    ///< the estimate begins anew
  };

  /// Largest absolute innovation of each output, its unit, > 0; empty where `mahalanobis` limits.
  Eigen::VectorXd innovation;
  /// Largest √(νᵀ S⁻¹ ν) of the innovation ν with the covariance S, > 0.
  double mahalanobis = 0.0;
  /// Time of rejections only after which the gate recovers [ns], > 0.
  Duration recover_after = 0;
  Recovery recovery = Recovery::kAccept;
};

/// A law that takes no samples whose innovation lies outside the gate of their sensor. Which ones
/// it takes is a function of the events, not of their arrival.
///
/// When a gate is open, and when it recovers: see GateState. With Recovery::kReset the estimate
/// begins anew before a sample is used, as configured (the input, the continuous outputs and the
/// mode go on holding); then all gates are open, and a guaranteed error bound is lost.
///
/// An innovation that has no value passes: the law's own reset will have none either.
class GatedSamples : public LawDecorator {
 public:
  /// @param gates  one per sensor, nothing for a sensor without
  /// @throws std::invalid_argument for limits out of range, a gate of a sensor that is not sampled,
  /// and a Mahalanobis distance where the law has no covariance.
  GatedSamples(const std::shared_ptr<const ObserverLaw>& law,
               const std::vector<std::optional<Gate>>& gates);

  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;

 private:
  /// A gate and what the state holds of it.
  struct GateInUse {
    Gate gate;
    GateState kept;
  };

  Effect reset(const GateInUse& of_sensor, const Event& sample, double* state,
               double* workspace) const;
  bool is_outside(const Gate& gate, const Event& sample, const double* state,
                  double* workspace) const;
  void begin_anew(double* state, double* workspace) const;

  std::vector<std::optional<GateInUse>> gates_;
  VectorSlot innovation_ = scratch(law().max_event_size());
  VectorSlot before_ = scratch(law().state_size());
};

}  // namespace sampled_data_observers
