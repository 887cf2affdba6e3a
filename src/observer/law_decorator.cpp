#include "observer/law_decorator.h"

#include <typeinfo>

namespace sampled_data_observers {
namespace {

/// Null where it has no layer.
const LawDecorator* outer_layer(const ObserverLaw& law) {
  return dynamic_cast<const LawDecorator*>(&law);
}

const LawDecorator* layer_like(const LawDecorator& layer, const ObserverLaw& law) {
  const LawDecorator* found = outer_layer(law);
  while (found != nullptr && typeid(*found) != typeid(layer)) found = outer_layer(found->law());
  return found;
}

void keep_records(VectorSlot (LawDecorator::*records)() const, const ObserverLaw& from,
                  const double* before, const ObserverLaw& law, double* state) {
  const LawDecorator* layer = outer_layer(law);
  for (; layer != nullptr; layer = outer_layer(layer->law())) {
    const LawDecorator* other = layer_like(*layer, from);
    if (other == nullptr) continue;
    const VectorSlot kept = (other->*records)();
    const VectorSlot place = (layer->*records)();
    if (kept.size() == place.size()) place.set(kept.of(before), state);
  }
}

}  // namespace

void keep_records_of_jumps(const ObserverLaw& from, const double* before, const ObserverLaw& law,
                           double* state) {
  keep_records(&LawDecorator::records_of_jumps, from, before, law, state);
}

void keep_records_of_estimate(const ObserverLaw& from, const double* before, const ObserverLaw& law,
                              double* state) {
  keep_records(&LawDecorator::records_of_estimate, from, before, law, state);
}

}  // namespace sampled_data_observers
