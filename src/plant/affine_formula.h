#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sampled_data_observers/plant/expression_map.h"

namespace sampled_data_observers {

/// The affine map that formulas are, such as "101325 - 11.9*z"; null where one of them is none, or
/// can't be told to be: those that are written with numbers, names, + - * / and brackets can.
/// @param texts  that an ExpressionMap of the same names takes
std::shared_ptr<const AffineMap> affine_map_of(const ExpressionNames& names,
                                               const std::vector<std::string>& texts);

}  // namespace sampled_data_observers
