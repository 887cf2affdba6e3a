#include "certificate/numeric_algebra.h"

#include <stdexcept>
#include <vector>

#include "certificate/evaluate_expression.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

class NumericAlgebra {
 public:
  using Matrix = Eigen::MatrixXd;

  NumericAlgebra(const NamedMatrices& values, double tau) : values_(values), tau_(tau) {}

  Matrix constant(const Matrix& value) { return value; }
  Matrix symbol(const MatrixExpression::Node& node) { return value_of(node, values_); }
  Matrix square(const MatrixExpression::Node& node) {
    const double root = value_of(node, values_)(0, 0);
    return scalar_matrix(root * root);
  }
  Matrix time() { return scalar_matrix(tau_); }
  Matrix sum(const Matrix& a, const Matrix& b) { return a + b; }
  Matrix product(const Matrix& a, const Matrix& b) { return a * b; }
  Matrix scaled(const Matrix& scalar, const Matrix& a) { return scalar(0, 0) * a; }
  Matrix transpose(const Matrix& a) { return a.transpose(); }
  Matrix inverse(const Matrix& a) { return inverse_of(a); }
  Matrix exponential(const Matrix& a) { return exponential_of(a); }
  Matrix blocks(const MatrixExpression::Node& node, const std::vector<const Matrix*>& operands) {
    return joined_blocks(node, operands);
  }

 private:
  const NamedMatrices& values_;
  double tau_;
};

}  // namespace

double scalar_value(const NamedMatrices& values, const std::string& name) {
  const auto found = values.find(name);
  if (found == values.end()) throw std::out_of_range("there is no value for '" + name + "'");
  return found->second(0, 0);
}

Eigen::MatrixXd scalar_matrix(double value) { return Eigen::MatrixXd::Constant(1, 1, value); }

const Eigen::MatrixXd& value_of(const MatrixExpression::Node& symbol, const NamedMatrices& values) {
  const auto found = values.find(symbol.name);
  if (found == values.end()) throw std::out_of_range("there is no value for '" + symbol.name + "'");
  const Eigen::MatrixXd& value = found->second;
  if (value.rows() != symbol.rows || value.cols() != symbol.cols) {
    throw std::invalid_argument("'" + symbol.name + "' must be " + std::to_string(symbol.rows) +
                                " x " + std::to_string(symbol.cols));
  }
  return value;
}

Eigen::MatrixXd joined_blocks(const MatrixExpression::Node& node,
                              const std::vector<const Eigen::MatrixXd*>& blocks) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(node.rows, node.cols);
  const std::size_t columns = blocks.size() / node.block_rows;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < node.block_rows; ++i) {
    Eigen::Index col = 0;
    for (std::size_t j = 0; j < columns; ++j) {
      const MatrixExpression& operand = node.operands[i * columns + j];
      const Eigen::MatrixXd& block = *blocks[i * columns + j];
      if (block.size() > 0) whole.block(row, col, operand.rows(), operand.cols()) = block;
      col += operand.cols();
    }
    row += node.operands[i * columns].rows();
  }
  return whole;
}

Eigen::MatrixXd evaluate(const MatrixExpression& expression, const NamedMatrices& values,
                         double tau) {
  NumericAlgebra algebra(values, tau);
  return ExpressionEvaluator<NumericAlgebra>(algebra).evaluate(expression);
}

}  // namespace sampled_data_observers
