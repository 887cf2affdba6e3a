#pragma once

#include <string>

#include "replay/comparison.h"
#include "sampled_data_observers/config/plant_config.h"

namespace sampled_data_observers {

/// The unit of a quantity, by its name; "rad" of angles that have none, else empty.
std::string unit_of(const Quantity& quantity, const Units& units);

}  // namespace sampled_data_observers
