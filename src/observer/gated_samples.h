#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

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
/// A gate is open, and lets everything pass, from the start until a sample lies inside it: an
/// initial estimate is no measure of outliers. When every sample for recover_after, counted from
/// the first one rejected, was rejected, the next one outside opens the gate again: it is used, and
/// so are all others until one lies inside. With Recovery::kReset the estimate begins anew before,
/// as configured (the input, the continuous outputs and the mode go on holding); then all gates are
/// open, and a guaranteed error bound is lost.
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
  enum class Standing : std::uint8_t {
    kOpen,      ///< nothing was inside since the start
    kClosed,    ///< the last sample was inside
    kRejecting  ///< it was not, and was not used
  };
  /// A gate and what the state holds of it.
  struct GateInUse {
    Gate gate;
    ChoiceSlot<Standing> standing;
    TimerSlot since_rejected;  ///< the first of the samples rejected one after another
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
