#include "certificate/matrix_expression.h"

#include <stdexcept>
#include <utility>

namespace sampled_data_observers {
namespace {

using Kind = MatrixExpression::Kind;
using Node = MatrixExpression::Node;

std::string size_of(const MatrixExpression& a) {
  return std::to_string(a.rows()) + " x " + std::to_string(a.cols());
}

void require_fit(bool fits, const char* operation, const MatrixExpression& a,
                 const MatrixExpression& b) {
  if (fits) return;
  throw std::invalid_argument(std::string(operation) + " of a " + size_of(a) + " and a " +
                              size_of(b) + " matrix");
}

MatrixExpression make(Kind kind, Eigen::Index rows, Eigen::Index cols,
                      std::vector<MatrixExpression> operands) {
  auto node = std::make_shared<Node>();
  node->kind = kind;
  node->rows = rows;
  node->cols = cols;
  node->operands = std::move(operands);
  return MatrixExpression(std::move(node));
}

MatrixExpression make_constant(const Eigen::MatrixXd& constant) {
  auto node = std::make_shared<Node>();
  node->rows = constant.rows();
  node->cols = constant.cols();
  node->constant = constant;
  return MatrixExpression(std::move(node));
}

MatrixExpression make_named(Kind kind, const std::string& name, Eigen::Index rows,
                            Eigen::Index cols) {
  auto node = std::make_shared<Node>();
  node->kind = kind;
  node->rows = rows;
  node->cols = cols;
  node->name = name;
  return MatrixExpression(std::move(node));
}

bool is_scalar(const MatrixExpression& a) { return a.rows() == 1 && a.cols() == 1; }

void require_square(const char* operation, const MatrixExpression& a) {
  if (a.rows() == a.cols()) return;
  throw std::invalid_argument(std::string(operation) + " of a " + size_of(a) + " matrix");
}

}  // namespace

MatrixExpression::MatrixExpression(const Eigen::MatrixXd& constant)
    : MatrixExpression(make_constant(constant)) {}

MatrixExpression::MatrixExpression(double constant)
    : MatrixExpression(make_constant(Eigen::MatrixXd::Constant(1, 1, constant))) {}

MatrixExpression symbol(const std::string& name, Eigen::Index rows, Eigen::Index cols) {
  return make_named(Kind::kSymbol, name, rows, cols);
}

MatrixExpression square(const std::string& name) { return make_named(Kind::kSquare, name, 1, 1); }

MatrixExpression time_tau() { return make(Kind::kTime, 1, 1, {}); }

MatrixExpression identity(Eigen::Index n) {
  return MatrixExpression(Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n)));
}

MatrixExpression zeros(Eigen::Index rows, Eigen::Index cols) {
  return MatrixExpression(Eigen::MatrixXd(Eigen::MatrixXd::Zero(rows, cols)));
}

MatrixExpression operator+(const MatrixExpression& a, const MatrixExpression& b) {
  require_fit(a.rows() == b.rows() && a.cols() == b.cols(), "sum", a, b);
  return make(Kind::kSum, a.rows(), a.cols(), {a, b});
}

MatrixExpression operator-(const MatrixExpression& a, const MatrixExpression& b) { return a + -b; }

MatrixExpression operator-(const MatrixExpression& a) { return MatrixExpression(-1.0) * a; }

MatrixExpression operator*(const MatrixExpression& a, const MatrixExpression& b) {
  if (is_scalar(a)) return make(Kind::kScaled, b.rows(), b.cols(), {a, b});
  if (is_scalar(b)) return make(Kind::kScaled, a.rows(), a.cols(), {b, a});
  require_fit(a.cols() == b.rows(), "product", a, b);
  return make(Kind::kProduct, a.rows(), b.cols(), {a, b});
}

MatrixExpression transpose(const MatrixExpression& a) {
  return make(Kind::kTranspose, a.cols(), a.rows(), {a});
}

MatrixExpression inverse(const MatrixExpression& a) {
  require_square("inverse", a);
  return make(Kind::kInverse, a.rows(), a.rows(), {a});
}

MatrixExpression exponential(const MatrixExpression& a) {
  require_square("exponential", a);
  return make(Kind::kExponential, a.rows(), a.rows(), {a});
}

MatrixExpression He(const MatrixExpression& a) { return a + transpose(a); }

MatrixExpression blocks(const std::vector<std::vector<MatrixExpression>>& rows) {
  auto node = std::make_shared<Node>();
  node->kind = Kind::kBlocks;
  node->block_rows = rows.size();
  for (const auto& row : rows) {
    if (row.size() != rows.front().size()) {
      throw std::invalid_argument("blocks: rows of different lengths");
    }
    for (std::size_t j = 0; j < row.size(); ++j) {
      require_fit(row[j].rows() == row.front().rows(), "blocks, in a row,", row[j], row.front());
      require_fit(row[j].cols() == rows.front()[j].cols(), "blocks, in a column,", row[j],
                  rows.front()[j]);
      node->operands.push_back(row[j]);
    }
    node->rows += row.front().rows();
  }
  for (const MatrixExpression& block : rows.front()) node->cols += block.cols();
  return MatrixExpression(std::move(node));
}

MatrixExpression symmetric_blocks(const std::vector<std::vector<MatrixExpression>>& rows) {
  std::vector<std::vector<MatrixExpression>> whole;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != rows.size() - i) {
      throw std::invalid_argument("symmetric_blocks: row " + std::to_string(i + 1) +
                                  " must go from the diagonal to the last column");
    }
    std::vector<MatrixExpression> row;
    for (std::size_t j = 0; j < i; ++j) row.push_back(transpose(rows[j][i - j]));
    row.insert(row.end(), rows[i].begin(), rows[i].end());
    whole.push_back(std::move(row));
  }
  return blocks(whole);
}

}  // namespace sampled_data_observers
