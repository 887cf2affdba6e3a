#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/expression_map.h"

namespace sampled_data_observers {

/// The affine map that formulas are, such as "101325 - 11.9*z" or "cos(0.3)*x + d"; null where one
/// of them is none, or is not seen to be, as "x^2/x".
/// @param texts  that an ExpressionMap of the same names takes
std::shared_ptr<const AffineMap> affine_map_of(const ExpressionNames& names,
                                               const std::vector<std::string>& texts);

}  // namespace sampled_data_observers
