#include "sampled_data_observers/observer/observer_law.h"

#include "sampled_data_observers/observer/plant_observer.h"

namespace sampled_data_observers {

const std::vector<std::string>& ObserverLaw::estimate_names() const {
  return observer().plant().state_names();
}

std::size_t ObserverLaw::told_mode(const double* state) const {
  const double* next = awaited(state);
  return observer().mode_of(next != nullptr ? next : state);
}

}  // namespace sampled_data_observers
