#include "observer/numbered_jumps.h"

#include <utility>

namespace sampled_data_observers {

NumberedJumps::NumberedJumps(std::shared_ptr<const ObserverLaw> law)
    : LawDecorator(std::move(law)) {
  set_skipped_jumps(skipped_);
}

void NumberedJumps::initialize(double* state) const {
  law().initialize(state);
  last_.set(0.0, state);
  told_.set(0.0, state);
  gap_.set(0.0, state);
  skipped_.set(0.0, state);
}

void NumberedJumps::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
}

Effect NumberedJumps::reset(const Event& event, double* state, double* workspace) const {
  const bool is_jump = event.kind == EventKind::kJump;
  const bool is_numbered = event.index != 0 && (is_jump || event.kind == EventKind::kWithdrawal);
  if (!is_numbered) return law().reset(event, state, workspace);
  const auto number = static_cast<double>(event.index);
  if (is_jump && last_.of(state) == number) return Effect::kRepeated;
  // A jump that was withdrawn, or is refused, was not lost.
  note_number(number, state);
  const Effect effect = law().reset(event, state, workspace);
  if (is_jump && took_effect(effect)) last_.set(number, state);
  return effect;
}

void NumberedJumps::note_number(double number, double* state) const {
  const double told = told_.of(state);
  if (told == 0.0 || number > told) {
    const double gap = told == 0.0 ? 0.0 : number - told - 1.0;
    told_.set(number, state);
    gap_.set(gap, state);
    skipped_.set(skipped_.of(state) + gap, state);
  } else if (number == 1.0 && told > 1.0) {
    told_.set(number, state);
    gap_.set(0.0, state);
  } else if (number < told && gap_.of(state) > 0.0) {
    gap_.set(gap_.of(state) - 1.0, state);
    skipped_.set(skipped_.of(state) - 1.0, state);
  }
}

}  // namespace sampled_data_observers
