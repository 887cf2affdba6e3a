#pragma once

#include <map>
#include <string>

#include "plant/formula_graph.h"
#include "sampled_data_observers/plant/expression_map.h"

namespace sampled_data_observers {

/// What formulas may use, by name, as nodes of a graph: states, behind them inputs, as its
/// variables, constants, and those of muParser.
std::map<std::string, FormulaGraph::Node> nodes_of_names(const ExpressionNames& names,
                                                         FormulaGraph& graph);

/// Adds a formula in muParser's syntax, which muParser accepts, to a graph.
/// @param names  what the formula may use
/// @throws std::invalid_argument for one that is nested too deeply, or is not of that syntax.
FormulaGraph::Node parse_formula(const std::string& text,
                                 const std::map<std::string, FormulaGraph::Node>& names,
                                 FormulaGraph& graph);

}  // namespace sampled_data_observers
