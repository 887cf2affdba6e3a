#pragma once

#include <string>

#include "sampled_data_observers/observer/estimator.h"
#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// Looks for times between samples in [T1, T2] at which the error of an observer grows from sample
/// to sample: constant times, and pairs that alternate, all sensors sampled together. The map of
/// the error over one sample is taken from the law itself, gains that vary with time and settled
/// covariances included.
/// @param law  without decorators
/// @return what was found, for a person; empty where nothing was, and for a law that is not linear,
/// a plant that jumps or one without sampled sensors.
std::string find_divergence(const ObserverLaw& law, const Plant& plant,
                            const SamplingBounds& sampling);

}  // namespace sampled_data_observers
