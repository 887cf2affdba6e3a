#include "plant/formula_program.h"

#include <map>
#include <string>

#include "plant/formula_parser.h"

namespace sampled_data_observers {

FormulaProgram::FormulaProgram(const FormulaGraph& graph, std::size_t states,
                               const std::vector<FormulaGraph::Node>& results) {
  const std::vector<bool> needed = graph.needed_by(results);
  std::vector<std::size_t> places(needed.size(), 0);
  const auto is_leaf = [&](FormulaGraph::Node node) {
    return graph.entry(node).operation <= FormulaOperation::kVariable;
  };
  for (FormulaGraph::Node node = 0; node < needed.size(); ++node) {
    if (!needed[node] || !is_leaf(node)) continue;
    const FormulaGraph::Entry& entry = graph.entry(node);
    places[node] = values_.size();
    values_.push_back(entry.value);
    if (entry.operation == FormulaOperation::kConstant) continue;
    const bool is_state = entry.variable < states;
    (is_state ? states_ : inputs_)
        .push_back({places[node], entry.variable - (is_state ? 0 : states)});
  }
  first_result_ = values_.size();
  for (FormulaGraph::Node node = 0; node < needed.size(); ++node) {
    if (!needed[node] || is_leaf(node)) continue;
    const FormulaGraph::Entry& entry = graph.entry(node);
    places[node] = first_result_ + instructions_.size();
    instructions_.push_back({entry.operation, places[entry.a], places[entry.b], places[entry.c]});
  }
  values_.resize(first_result_ + instructions_.size());
  for (const FormulaGraph::Node node : results) results_.push_back(places[node]);
}

void FormulaProgram::evaluate(const double* x, const double* u, double* out) const {
  double* values = values_.data();
  for (const Variable& state : states_) values[state.place] = x[state.index];
  for (const Variable& input : inputs_) values[input.place] = u[input.index];
  double* result = values + first_result_;
  for (const Instruction& step : instructions_) {
    *result++ = operate(step.operation, values[step.a], values[step.b], values[step.c]);
  }
  for (const std::size_t place : results_) *out++ = values[place];
}

std::shared_ptr<const VectorMap> differentiated(const ExpressionNames& names,
                                                const std::vector<NamedExpression>& definitions,
                                                const std::vector<NamedExpression>& expressions) {
  FormulaGraph graph;
  std::map<std::string, FormulaGraph::Node> known = nodes_of_names(names, graph);
  for (const NamedExpression& definition : definitions) {
    known[definition.name] = parse_formula(definition.text, known, graph);
  }
  std::vector<FormulaGraph::Node> results;
  for (const NamedExpression& expression : expressions) {
    results.push_back(parse_formula(expression.text, known, graph));
  }
  std::vector<FormulaGraph::Node> derivatives;
  for (std::size_t j = 0; j < names.x.size(); ++j) {
    const std::vector<FormulaGraph::Node> by_state = graph.derivatives(results, j);
    derivatives.insert(derivatives.end(), by_state.begin(), by_state.end());
  }
  return std::make_shared<const FormulaProgram>(graph, names.x.size(), derivatives);
}

}  // namespace sampled_data_observers
