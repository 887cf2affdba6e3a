#pragma once

#include <memory>

#include "observer/gate_state.h"
#include "observer/law_decorator.h"
#include "observer/state_set.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Where a plant may jump, and when to believe the jumps and no longer the estimate.
struct JumpGate {
  /// The jump set D of bernard2022 (1), widened by what the estimate may be off.
  StateSet jump_set;
  /// Time of refusals only after which jumps are taken again [ns], > 0.
  Duration recover_after = 0;
};

/// A law that takes no jump where its estimate says that the plant can't jump: false alarms of a
/// detector, and jumps told twice. Which ones it takes is a function of the events, not of their
/// arrival. When its gate is open, and when it recovers: see GateState.
class PossibleJumps : public LawDecorator {
 public:
  /// @throws std::invalid_argument for a gate out of range.
  PossibleJumps(std::shared_ptr<const ObserverLaw> law, JumpGate gate);

  void initialize(double* state) const override;
  void flow(Duration duration, double* state, double* workspace) const override;
  Effect reset(const Event& event, double* state, double* workspace) const override;
  VectorSlot records_of_estimate() const override { return own_records(); }

 private:
  JumpGate gate_;
  GateState kept_{state_layout(), gate_.recover_after};
  VectorSlot values_ = scratch(gate_.jump_set.margins.size());
};

}  // namespace sampled_data_observers
