#include "observer/possible_jumps.h"

#include <stdexcept>
#include <utility>

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

PossibleJumps::PossibleJumps(std::shared_ptr<const ObserverLaw> law, JumpGate gate)
    : LawDecorator(std::move(law)), gate_(std::move(gate)) {
  if (!gate_.jump_set.fits(observer().plant().modes().size())) {
    throw std::invalid_argument(
        "PossibleJumps: a jump set for each mode, and one margin for each of its formulas");
  }
  if (gate_.recover_after <= 0) {
    throw std::invalid_argument("PossibleJumps: recover_after must be positive");
  }
}

void PossibleJumps::initialize(double* state) const {
  law().initialize(state);
  kept_.initialize(state);
}

void PossibleJumps::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
  kept_.advance(duration, state);
}

Effect PossibleJumps::reset(const Event& event, double* state, double* workspace) const {
  if (event.kind != EventKind::kJump) return law().reset(event, state, workspace);
  const double* u = observer().held_part(state);
  const bool is_outside =
      !gate_.jump_set.contains(observer().mode_of(state), state, u, values_.of(workspace));
  const GateState::Verdict verdict = kept_.judge(is_outside, state);
  if (verdict == GateState::Verdict::kReject) return Effect::kNotPossible;
  const Effect effect = law().reset(event, state, workspace);
  const bool recovers = verdict == GateState::Verdict::kRecover && effect == Effect::kApplied;
  return recovers ? Effect::kPastGate : effect;
}

}  // namespace sampled_data_observers
