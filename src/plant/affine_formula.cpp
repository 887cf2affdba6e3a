#include "plant/affine_formula.h"

#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "plant/formula_parser.h"

namespace sampled_data_observers {
namespace {

/// Coefficients of x and u, and behind them the constant; nothing for what is not affine.
using AffineForm = std::optional<Eigen::RowVectorXd>;

AffineForm product_of(const AffineForm& a, const AffineForm& b, Eigen::Index variables) {
  const auto is_constant = [&](const AffineForm& form) {
    return form->head(variables).isZero(0.0);
  };
  if (is_constant(*b)) return *a * (*b)(variables);
  if (is_constant(*a)) return (*a)(variables) * *b;
  return std::nullopt;
}

/// The form of each node up to `last`.
std::vector<AffineForm> affine_forms(const FormulaGraph& graph, FormulaGraph::Node last,
                                     Eigen::Index variables) {
  std::vector<AffineForm> forms(last + 1);
  for (FormulaGraph::Node node = 0; node <= last; ++node) {
    const FormulaGraph::Entry& at = graph.entry(node);
    AffineForm& form = forms[node];
    if (at.operation <= FormulaOperation::kVariable) {
      form = Eigen::RowVectorXd::Zero(variables + 1);
      const bool is_constant = at.operation == FormulaOperation::kConstant;
      (*form)(is_constant ? variables : static_cast<Eigen::Index>(at.variable)) =
          is_constant ? at.value : 1.0;
      continue;
    }
    const AffineForm& a = forms[at.a];
    const AffineForm& b = forms[at.b];
    if (!a || !b) continue;
    if (at.operation == FormulaOperation::kAdd) {
      form = *a + *b;
    } else if (at.operation == FormulaOperation::kSubtract) {
      form = *a - *b;
    } else if (at.operation == FormulaOperation::kNegate) {
      form = -*a;
    } else if (at.operation == FormulaOperation::kMultiply) {
      form = product_of(a, b, variables);
    } else if (at.operation == FormulaOperation::kDivide && b->head(variables).isZero(0.0)) {
      form = *a / (*b)(variables);
    }
  }
  return forms;
}

}  // namespace

std::shared_ptr<const AffineMap> affine_map_of(const ExpressionNames& names,
                                               const std::vector<std::string>& texts) {
  const auto n = static_cast<Eigen::Index>(names.x.size());
  const auto p = static_cast<Eigen::Index>(names.u.size());
  FormulaGraph graph;
  const std::map<std::string, FormulaGraph::Node> known = nodes_of_names(names, graph);
  const auto size = static_cast<Eigen::Index>(texts.size());
  Eigen::MatrixXd M(size, n);
  Eigen::MatrixXd N(size, p);
  Eigen::VectorXd c(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    FormulaGraph::Node node = 0;
    try {
      node = parse_formula(texts[static_cast<std::size_t>(i)], known, graph);
    } catch (const std::invalid_argument&) {
      return nullptr;
    }
    const AffineForm form = affine_forms(graph, node, n + p).back();
    if (!form || !form->allFinite()) return nullptr;
    M.row(i) = form->head(n);
    N.row(i) = form->segment(n, p);
    c(i) = (*form)(n + p);
  }
  if (N.isZero(0.0)) N.resize(size, 0);
  return std::make_shared<const AffineMap>(std::move(M), std::move(N), std::move(c));
}

}  // namespace sampled_data_observers
