#pragma once

#include <memory>
#include <vector>

#include "plant/formula_graph.h"
#include "sampled_data_observers/plant/expression_map.h"
#include "sampled_data_observers/plant/vector_map.h"

namespace sampled_data_observers {

/// Nodes of a graph of formulas as a list of operations, each of which is computed once.
class FormulaProgram : public VectorMap {
 public:
  /// @param states   number of the graph's variables that are states; the inputs follow
  /// @param results  the entries of the map
  FormulaProgram(const FormulaGraph& graph, std::size_t states,
                 const std::vector<FormulaGraph::Node>& results);

  Eigen::Index size() const override { return static_cast<Eigen::Index>(results_.size()); }
  void evaluate(const double* x, const double* u, double* out) const override;

 private:
  struct Instruction {
    FormulaOperation operation;
    std::size_t a;
    std::size_t b;
    std::size_t c;
  };
  struct Variable {
    std::size_t place;  ///< among values_
    std::size_t index;  ///< among the states or inputs
  };

  std::vector<Variable> states_;
  std::vector<Variable> inputs_;
  std::vector<Instruction> instructions_;
  std::size_t first_result_ = 0;  ///< the place of what the first instruction gives; so on
  std::vector<std::size_t> results_;
  /// Constants, variables, then the results of the instructions.
  mutable std::vector<double> values_;
};

/// The derivatives of formulas by the states, symbolically: one entry for each formula and state,
/// those by the first state first.
/// @throws std::invalid_argument for formulas that are nested too deeply, std::length_error for
/// derivatives of too many operations.
std::shared_ptr<const VectorMap> differentiated(const ExpressionNames& names,
                                                const std::vector<NamedExpression>& definitions,
                                                const std::vector<NamedExpression>& expressions);

}  // namespace sampled_data_observers
