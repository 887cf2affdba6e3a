#pragma once

#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// P ← N P Nᵀ with the Jacobian N = (I − q qᵀ/|q|²)/|q| of the normalization of each group q of x
/// that is of unit norm in a plant. P is n x n, symmetric to the bit, and so again.
void project_covariance(const Plant& plant, const double* x, double* P);

}  // namespace sampled_data_observers
