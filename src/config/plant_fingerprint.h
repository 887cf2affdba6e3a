#pragma once

#include <string>

#include "sampled_data_observers/config/config_node.h"

namespace sampled_data_observers {

/// A fingerprint (a UUID by SHA-1) of what a configuration says of the plant and its measurements:
/// the section `plant` but for its `integration`, its `units` and the sets in which it
/// flows and jumps, and of each sensor C, h, output, measured,
/// angular and bias. Order of keys, comments and the way numbers are written don't matter.
std::string plant_fingerprint(const ConfigNode& root);

}  // namespace sampled_data_observers
