#pragma once

#include "certificate/matrix_expression.h"
#include "certificate/numeric_algebra.h"

namespace sampled_data_observers {

/// Not less than the least c >= 0 with M <= c P, for symmetric M and a P > 0, whatever rounding has
/// done to their values: that is checked, with a bound on its own rounding.
/// @throws std::invalid_argument where no c can be shown to bound it
double form_quotient_above(const MatrixExpression& M, const MatrixExpression& P,
                           const NamedMatrices& values);

}  // namespace sampled_data_observers
