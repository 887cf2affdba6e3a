#pragma once

#include <string>

#include "sampled_data_observers/observer/observer_law.h"
#include "sampled_data_observers/plant/plant.h"
#include "sampled_data_observers/runtime/estimator.h"

namespace sampled_data_observers {

/// Looks for times in [T1, T2] between samples, or between jumps of a plant without, at which the
/// error of an observer grows from one to the next: constant times, and pairs that alternate, all
/// sensors measured together; for a plant that switches, pairs of modes. Where sensors have times
/// of their own, those of the one that may be sampled least often, the others as seldom between
/// them as theirs let them be. The map of the error over one of them is taken from the law itself,
/// gains that vary with time and settled covariances included.
/// @param law  without decorators
/// @return what was found, for a person; empty where nothing was, and for a law that is not linear,
/// a plant that jumps and is sampled, or one that is measured continuously or not at all.
std::string find_divergence(const ObserverLaw& law, const Plant& plant,
                            const SensorSampling& sampling);

}  // namespace sampled_data_observers
