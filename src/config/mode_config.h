#pragma once

#include <memory>
#include <string>

#include "sampled_data_observers/config/config_section.h"
#include "sampled_data_observers/plant/expression_map.h"
#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// Reads the flow map of one mode: linear (A, B, b), Lipschitz (A, B, G, S, psi) or formulas
/// (flow).
std::shared_ptr<const VectorMap> read_flow_map(ConfigSection& mode, const ExpressionNames& names);

/// Reads the jump map of one mode, affine (A_d, b_d) or by formulas; null where there is none.
std::shared_ptr<const VectorMap> read_jump_map(ConfigSection& mode, const ExpressionNames& names);

/// Reads an output map: C, or h by formulas.
std::shared_ptr<const VectorMap> read_output_map(ConfigSection& sensor,
                                                 const ExpressionNames& names);

}  // namespace sampled_data_observers
