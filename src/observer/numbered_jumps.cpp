#include "observer/numbered_jumps.h"

#include <utility>

namespace sampled_data_observers {

NumberedJumps::NumberedJumps(std::shared_ptr<const ObserverLaw> law)
    : LawDecorator(std::move(law)) {}

void NumberedJumps::initialize(double* state) const {
  law().initialize(state);
  last_.set(0.0, state);
}

void NumberedJumps::flow(Duration duration, double* state, double* workspace) const {
  law().flow(duration, state, workspace);
}

Effect NumberedJumps::reset(const Event& event, double* state, double* workspace) const {
  if (event.kind != EventKind::kJump || event.index == 0) {
    return law().reset(event, state, workspace);
  }
  const auto index = static_cast<double>(event.index);
  if (last_.of(state) == index) return Effect::kRepeated;
  const Effect effect = law().reset(event, state, workspace);
  if (took_effect(effect)) last_.set(index, state);
  return effect;
}

}  // namespace sampled_data_observers
