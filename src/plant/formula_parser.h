#pragma once

#include <map>
#include <string>

#include "plant/formula_graph.h"

namespace sampled_data_observers {

/// Adds a formula in muParser's syntax, which muParser accepts, to a graph.
/// @param names  what the formula may use, muParser's own constants among them
/// @throws std::invalid_argument for one that is nested too deeply, or is not of that syntax.
FormulaGraph::Node parse_formula(const std::string& text,
                                 const std::map<std::string, FormulaGraph::Node>& names,
                                 FormulaGraph& graph);

}  // namespace sampled_data_observers
