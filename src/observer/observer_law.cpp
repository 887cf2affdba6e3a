#include "sampled_data_observers/observer/observer_law.h"

namespace sampled_data_observers {

void ObserverLaw::reset(const Event& event, double* state, double* workspace) const {
  switch (event.kind) {
    case EventKind::kSample:
      return sample(static_cast<std::size_t>(event.channel), event.values, state, workspace);
    case EventKind::kJump:
      return jump(state, workspace);
    case EventKind::kInput:
      return input(event.values, state);
  }
}

}  // namespace sampled_data_observers
