#pragma once

#include "design/plant_scaling.h"

namespace sampled_data_observers {

/// Units of states and outputs in which the entries of A T2, C, C_c, C_d and A_d, but for zeros and
/// the diagonals, are as near to 1 as possible: the sum of the squares of their logarithms is least
/// (Curtis and Reid, 1972). Whatever the units of the plant file, they make the same plant of it.
void balance_logarithms(const CertificateSubject& subject, PlantScaling& scaling);

}  // namespace sampled_data_observers
