#include "replay/report/report_units.h"

namespace sampled_data_observers {

std::string unit_of(const Quantity& quantity, const Units& units) {
  const auto found = units.find(quantity.name);
  if (found != units.end()) return found->second;
  return quantity.angular ? "rad" : "";
}

}  // namespace sampled_data_observers
