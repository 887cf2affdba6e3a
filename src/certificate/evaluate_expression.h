#pragma once

#include <unordered_map>
#include <vector>

#include "certificate/matrix_expression.h"

namespace sampled_data_observers {

/// Computes an expression in an algebra, each shared part once. An Algebra has a type Matrix and
///
///     Matrix constant(const Eigen::MatrixXd&);
///     Matrix symbol(const MatrixExpression::Node&);
///     Matrix square(const MatrixExpression::Node&);
///     Matrix time();
///     Matrix sum(const Matrix&, const Matrix&);
///     Matrix product(const Matrix&, const Matrix&);
///     Matrix scaled(const Matrix& scalar, const Matrix&);
///     Matrix transpose(const Matrix&);
///     Matrix blocks(const MatrixExpression::Node&, const std::vector<const Matrix*>&);
///     Matrix inverse(const Matrix&);
///     Matrix exponential(const Matrix&);
template <class Algebra>
class ExpressionEvaluator {
 public:
  using Matrix = typename Algebra::Matrix;

  explicit ExpressionEvaluator(Algebra& algebra) : algebra_(algebra) {}

  const Matrix& evaluate(const MatrixExpression& expression) {
    const MatrixExpression::Node& node = expression.node();
    const auto known = known_.find(&node);
    if (known != known_.end()) return known->second;
    std::vector<const Matrix*> operands;
    for (const MatrixExpression& operand : node.operands) operands.push_back(&evaluate(operand));
    return known_.emplace(&node, compute(node, operands)).first->second;
  }

 private:
  Matrix compute(const MatrixExpression::Node& node, const std::vector<const Matrix*>& operands) {
    using Kind = MatrixExpression::Kind;
    switch (node.kind) {
      case Kind::kConstant:
        return algebra_.constant(node.constant);
      case Kind::kSymbol:
        return algebra_.symbol(node);
      case Kind::kSquare:
        return algebra_.square(node);
      case Kind::kTime:
        return algebra_.time();
      case Kind::kSum:
        return algebra_.sum(*operands[0], *operands[1]);
      case Kind::kProduct:
        return algebra_.product(*operands[0], *operands[1]);
      case Kind::kScaled:
        return algebra_.scaled(*operands[0], *operands[1]);
      case Kind::kTranspose:
        return algebra_.transpose(*operands[0]);
      case Kind::kBlocks:
        return algebra_.blocks(node, operands);
      case Kind::kInverse:
        return algebra_.inverse(*operands[0]);
      case Kind::kExponential:
        break;
    }
    return algebra_.exponential(*operands[0]);
  }

  Algebra& algebra_;
  // References into it stay valid as it grows.
  std::unordered_map<const MatrixExpression::Node*, Matrix> known_;
};

}  // namespace sampled_data_observers
