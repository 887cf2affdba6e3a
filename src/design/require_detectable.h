#pragma once

#include "certificate/plant_matrices.h"

namespace sampled_data_observers {

/// Without detectability of (A, C) no gain makes the error converge, however often the plant is
/// measured. Looks at plants with a sampled output that neither jump nor switch, and for a
/// nonlinear flow only where the conditions are about its Lipschitz constant: they contain the flow
/// by A alone. Of others it says nothing.
/// @throws DesignError naming the unseen modes that don't decay, and the states they move
void require_detectable(const PlantMatrices& plant);

}  // namespace sampled_data_observers
