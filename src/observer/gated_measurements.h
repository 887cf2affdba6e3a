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

/// Which measurements of a sensor are outliers, and what to do when there are nothing but outliers.
struct Gate {
  enum class Recovery : std::uint8_t {
    kAccept,  ///< they are used again
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

/// A law that uses no measurement whose innovation lies outside the gate of its sensor. Which ones
/// it uses is a function of the events, not of their arrival.
///
/// - A sample outside has no effect.
/// - Of a continuous output, the value before goes on being held.
/// - An output measured at a jump is compared with the estimate before the jump. Where it lies
///   outside the plant has jumped all the same: the jump is applied with the other outputs only. A
///   jump that the law refuses is none, and its outputs tell the gates nothing.
///
/// When a gate is open, and when it recovers: see GateState. With Recovery::kReset the estimate
/// begins anew before the measurement is used, as configured (the input, the continuous outputs and
/// the mode go on holding, what is known of jumps stays), and jumps where that was measured at a
/// jump; then all gates are open, and a guaranteed error bound is lost.
///
/// An innovation that has no value passes: the law's own reset will have none either.
class GatedMeasurements : public LawDecorator {
 public:
  /// @param gates  one per sensor, nothing for a sensor without
  /// @throws std::invalid_argument for limits out of range, and a Mahalanobis distance where the
  /// law has no covariance.
  GatedMeasurements(const std::shared_ptr<const ObserverLaw>& law,
                    const std::vector<std::optional<Gate>>& gates);

  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  double gate_share(const Event& measured, const double* state, double* workspace) const override;
  VectorSlot records_of_estimate() const override { return standing_; }

 private:
  /// A gate and what the state holds of it.
  struct GateInUse {
    Gate gate;
    GateState kept;
  };
  /// A sensor that measures at jumps, and where its outputs begin among all that do.
  struct JumpSensor {
    std::size_t sensor = 0;
    Eigen::Index outputs = 0;
    Eigen::Index offset = 0;
  };
  /// What the gates say of the outputs that came with a jump.
  struct Verdicts {
    bool reject = false;   ///< of one of them, at least
    bool recover = false;  ///< likewise
    bool restart = false;  ///< likewise: recover by beginning anew
  };

  void keep_track_of_jumps();
  bool watches_jumps() const { return !jump_sensors_.empty(); }
  Effect measured(const GateInUse& of_sensor, const Event& event, double* state,
                  double* workspace) const;
  Effect jump(const Event& jump, double* state, double* workspace) const;
  Effect jump_output(const Event& output, double* state, double* workspace) const;
  Effect jump_anew(const Event& output, double* state, double* workspace) const;
  Verdicts judge_outputs(const Event& jump, double* state, double* workspace) const;
  Effect jump_with_those_inside(const Event& jump, double* state, double* workspace) const;
  void remember(const Event& jump, const double* before, double* state) const;
  bool is_outside(const Gate& gate, const Event& event, const double* state,
                  double* workspace) const;
  void begin_anew(const double* before, double* state) const;

  std::vector<std::optional<GateInUse>> gates_;
  VectorSlot standing_;  ///< all that the state holds of them
  VectorSlot innovation_ = scratch(law().max_event_size());
  VectorSlot before_;  ///< scratch: the whole state before an event

  // Where there are gates of outputs that are measured at jumps. In the state, of the last jump
  // that had effect, for those outputs of the same stamp that are events of their own:
  std::vector<JumpSensor> jump_sensors_;
  FlagSlot has_jumped_;
  TimerSlot since_jump_;
  VectorSlot before_jump_;  ///< the state of the law within just before it
  NumberSlot mode_;         ///< label of the one that followed
  NumberSlot index_;
  VectorSlot y_d_;        ///< what was measured at it, and is used
  FlagsSlot y_d_known_;   ///< of which sensors
  VectorSlot own_;        ///< all that this law keeps in the state
  VectorSlot is_inside_;  ///< scratch: 1 for each sensor whose outputs at a jump are used
};

}  // namespace sampled_data_observers
