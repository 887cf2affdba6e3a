#pragma once

#include <vector>

#include "design/explained_trajectory.h"
#include "simulation/scenario.h"

namespace sampled_data_observers {

/// The true trajectory of a scenario, in about so many steps and two more for each jump.
/// Disturbances are left out between a jump and the step before it.
std::vector<TrajectoryStep> simulated_trajectory(Scenario scenario, std::size_t steps);

}  // namespace sampled_data_observers
