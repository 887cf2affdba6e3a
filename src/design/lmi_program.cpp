#include "design/lmi_program.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "certificate/evaluate_expression.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// The congruence D a D with a diagonal D that makes the largest coefficient, or the constant, of
/// each diagonal entry 1: it is as definite as a, and how far inside it is does not depend on
/// units.
AffineMatrix equilibrated(AffineMatrix a) {
  Eigen::VectorXd largest = a.constant.diagonal().cwiseAbs();
  for (const AffineMatrix::Term& term : a.terms) {
    if (term.row != term.col) continue;
    largest(term.row) = std::max(largest(term.row), std::abs(term.coefficient));
  }
  Eigen::VectorXd D = Eigen::VectorXd::Ones(largest.size());
  for (Eigen::Index i = 0; i < D.size(); ++i) {
    if (std::isfinite(largest(i)) && largest(i) > 0.0) D(i) = 1.0 / std::sqrt(largest(i));
  }
  a.constant = D.asDiagonal() * a.constant * D.asDiagonal();
  for (AffineMatrix::Term& term : a.terms) term.coefficient *= D(term.row) * D(term.col);
  return a;
}

}  // namespace

/// Symbols are decision variables or fixed values.
class LmiProgram::Algebra {
 public:
  using Matrix = AffineMatrix;

  Algebra(const LmiProgram& program, double tau) : program_(program), tau_(tau) {}

  Matrix constant(const Eigen::MatrixXd& value) { return {value, {}}; }

  Matrix symbol(const MatrixExpression::Node& node) {
    const Variable* variable = program_.find(node.name, false);
    if (variable != nullptr) return of_variable(*variable);
    return {value_of(node, program_.fixed_), {}};
  }

  Matrix square(const MatrixExpression::Node& node) {
    const Variable* variable = program_.find(node.name, true);
    if (variable != nullptr) return of_variable(*variable);
    const double root = value_of(node, program_.fixed_)(0, 0);
    return {scalar_matrix(root * root), {}};
  }

  Matrix time() { return {scalar_matrix(tau_), {}}; }

  Matrix sum(const Matrix& a, const Matrix& b) { return sampled_data_observers::sum(a, b); }
  Matrix product(const Matrix& a, const Matrix& b) { return sampled_data_observers::product(a, b); }
  Matrix scaled(const Matrix& scalar, const Matrix& a) {
    return sampled_data_observers::scaled(scalar, a);
  }
  Matrix transpose(const Matrix& a) { return sampled_data_observers::transpose(a); }
  Matrix inverse(const Matrix& a) { return {inverse_of(constant_of(a, "inverse")), {}}; }
  Matrix exponential(const Matrix& a) {
    return {exponential_of(constant_of(a, "exponential")), {}};
  }

  Matrix blocks(const MatrixExpression::Node& node, const std::vector<const Matrix*>& operands) {
    Matrix whole;
    whole.constant.resize(node.rows, node.cols);
    const std::size_t columns = operands.size() / node.block_rows;
    int row = 0;
    for (std::size_t i = 0; i < node.block_rows; ++i) {
      int col = 0;
      for (std::size_t j = 0; j < columns; ++j) {
        const Matrix& block = *operands[i * columns + j];
        whole.constant.block(row, col, block.constant.rows(), block.constant.cols()) =
            block.constant;
        for (const AffineMatrix::Term& term : block.terms) {
          whole.terms.push_back({term.variable, term.row + row, term.col + col, term.coefficient});
        }
        col += static_cast<int>(block.constant.cols());
      }
      row += static_cast<int>(operands[i * columns]->constant.rows());
    }
    return whole;
  }

 private:
  static const Eigen::MatrixXd& constant_of(const Matrix& a, const char* function) {
    if (a.is_constant()) return a.constant;
    throw std::logic_error(std::string("the ") + function + " of a decision variable");
  }

  const LmiProgram& program_;
  double tau_;
};

const LmiProgram::Variable* LmiProgram::find(const std::string& name, bool is_square) const {
  const auto found =
      std::find_if(variables_of_.begin(), variables_of_.end(), [&](const Variable& variable) {
        return variable.name == name && variable.is_square == is_square;
      });
  return found == variables_of_.end() ? nullptr : &*found;
}

AffineMatrix LmiProgram::of_variable(const Variable& variable) {
  AffineMatrix result;
  result.constant = Eigen::MatrixXd::Zero(variable.rows, variable.cols);
  int next = variable.first;
  for (int j = 0; j < variable.cols; ++j) {
    for (int i = variable.is_symmetric ? j : 0; i < variable.rows; ++i, ++next) {
      result.terms.push_back({next, i, j, 1.0});
      if (variable.is_symmetric && i != j) result.terms.push_back({next, j, i, 1.0});
    }
  }
  return result;
}

MatrixExpression LmiProgram::add(Variable variable, int scalars) {
  if (find(variable.name, false) != nullptr || find(variable.name, true) != nullptr) {
    throw std::logic_error("two decision variables '" + variable.name + "'");
  }
  variable.first = variables_;
  variables_ += scalars;
  MatrixExpression expression = variable.is_square
                                    ? sampled_data_observers::square(variable.name)
                                    : symbol(variable.name, variable.rows, variable.cols);
  variables_of_.push_back(std::move(variable));
  return expression;
}

MatrixExpression LmiProgram::symmetric(const std::string& name, Eigen::Index n) {
  return add({name, n, n, true, false, 0}, static_cast<int>(n * (n + 1) / 2));
}

MatrixExpression LmiProgram::matrix(const std::string& name, Eigen::Index rows, Eigen::Index cols) {
  return add({name, rows, cols, false, false, 0}, static_cast<int>(rows * cols));
}

MatrixExpression LmiProgram::scalar(const std::string& name) {
  return add({name, 1, 1, false, false, 0}, 1);
}

MatrixExpression LmiProgram::squared(const std::string& name) {
  return add({name, 1, 1, false, true, 0}, 1);
}

void LmiProgram::fix(const std::string& name, const Eigen::MatrixXd& value) {
  fixed_[name] = value;
}

void LmiProgram::require_positive(const std::string& name, const MatrixExpression& block) {
  if (block.rows() > 0) blocks_.push_back({name, block, true, 0.0});
}

void LmiProgram::require(const Condition& condition, std::size_t points) {
  if (condition.is_domain()) {
    const MatrixExpression::Node& node = condition.positive_definite.node();
    const bool is_variable =
        node.kind == MatrixExpression::Kind::kSymbol && find(node.name, false) != nullptr;
    if (!is_variable) return;
  }
  if (!condition.tau) {
    require_positive(condition.name, condition.positive_definite);
    return;
  }
  const double low = condition.tau->low;
  const double high = condition.tau->high;
  for (std::size_t i = 0; i < points; ++i) {
    const double tau =
        points > 1 ? low + (high - low) * static_cast<double>(i) / static_cast<double>(points - 1)
                   : low;
    require_at(condition, tau);
  }
}

void LmiProgram::require_at(const Condition& condition, double tau) {
  if (condition.positive_definite.rows() == 0) return;
  blocks_.push_back({condition.name, condition.positive_definite, true, tau});
}

void LmiProgram::require_negative(const std::string& name, const MatrixExpression& block) {
  require_positive(name, -block);
}

void LmiProgram::bound_above(const std::string& name, const MatrixExpression& small,
                             const MatrixExpression& large) {
  if (small.rows() > 0) blocks_.push_back({name, large - small, false, 0.0});
}

void LmiProgram::minimize(const MatrixExpression& objective) { objective_ = objective; }

std::vector<LmiProgram::Block> LmiProgram::compile() const {
  std::vector<Block> compiled;
  // Blocks of one τ share what they have in common.
  std::optional<Algebra> algebra;
  std::optional<ExpressionEvaluator<Algebra>> evaluator;
  double tau = 0.0;
  for (const NamedBlock& block : blocks_) {
    if (!evaluator || block.tau != tau) {
      tau = block.tau;
      algebra.emplace(*this, tau);
      evaluator.emplace(*algebra);
    }
    compiled.push_back(
        {block.name, equilibrated(evaluator->evaluate(block.expression)), block.is_strict});
  }
  return compiled;
}

std::optional<AffineMatrix> LmiProgram::compile_objective() const {
  if (!objective_) return std::nullopt;
  Algebra algebra(*this, 0.0);
  return ExpressionEvaluator<Algebra>(algebra).evaluate(*objective_);
}

NamedMatrices LmiProgram::unpack(const std::vector<double>& x) const {
  NamedMatrices values;
  for (const Variable& variable : variables_of_) {
    const Eigen::MatrixXd value = evaluate(of_variable(variable), x);
    values[variable.name] =
        variable.is_square ? scalar_matrix(std::sqrt(std::max(0.0, value(0, 0)))) : value;
  }
  return values;
}

std::vector<std::string> LmiProgram::describe_variables() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < variables_of_.size(); ++i) {
    const Variable& variable = variables_of_[i];
    const int last = i + 1 < variables_of_.size() ? variables_of_[i + 1].first : variables_;
    std::string line = "x" + std::to_string(variable.first + 1);
    if (last > variable.first + 1) line += " to x" + std::to_string(last);
    line += ": " + variable.name + (variable.is_square ? "^2" : "") + ", " +
            std::to_string(variable.rows) + " x " + std::to_string(variable.cols);
    if (variable.is_symmetric) line += ", symmetric: its lower triangle";
    lines.push_back(line);
  }
  return lines;
}

}  // namespace sampled_data_observers
