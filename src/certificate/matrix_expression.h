#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// A formula over real matrices, in which named symbols and the time τ are left open.
///
/// A condition of a paper is written once, as such a formula, and serves three purposes: with
/// numbers for its symbols it is checked (numeric_algebra.h), in ball arithmetic it is proved, and
/// with some symbols as decision variables it is a block of a linear matrix inequality. Scalars are
/// 1 x 1 matrices. Immutable, and cheap to copy.
class MatrixExpression {
 public:
  enum class Kind {
    kConstant,
    kSymbol,
    kSquare,  ///< the square of a 1 x 1 symbol, which a design may take as variable itself
    kTime,
    kSum,
    kProduct,
    kScaled,  ///< 1 x 1 times any size
    kTranspose,
    kBlocks,
    kInverse,
    kExponential
  };

  struct Node {
    Kind kind = Kind::kConstant;
    Eigen::Index rows = 0;
    Eigen::Index cols = 0;
    Eigen::MatrixXd constant;
    /// Of a symbol.
    std::string name;
    /// Of blocks: row by row.
    std::vector<MatrixExpression> operands;
    std::size_t block_rows = 0;
  };

  // Matrices and numbers stand in formulas as they are.
  MatrixExpression(const Eigen::MatrixXd& constant);  // NOLINT(google-explicit-constructor)
  MatrixExpression(double constant);                  // NOLINT(google-explicit-constructor)
  explicit MatrixExpression(std::shared_ptr<const Node> node) : node_(std::move(node)) {}

  const Node& node() const { return *node_; }
  Eigen::Index rows() const { return node_->rows; }
  Eigen::Index cols() const { return node_->cols; }

 private:
  std::shared_ptr<const Node> node_;
};

/// A matrix to be named later; a scalar where no size is given.
MatrixExpression symbol(const std::string& name, Eigen::Index rows = 1, Eigen::Index cols = 1);

/// The square of a scalar to be named later, such as γ².
MatrixExpression square(const std::string& name);

/// τ, the time since the last sample or jump [s].
MatrixExpression time_tau();

MatrixExpression identity(Eigen::Index n);
MatrixExpression zeros(Eigen::Index rows, Eigen::Index cols);

// All of these throw std::invalid_argument, with both sizes, where sizes do not fit.
MatrixExpression operator+(const MatrixExpression& a, const MatrixExpression& b);
MatrixExpression operator-(const MatrixExpression& a, const MatrixExpression& b);
MatrixExpression operator-(const MatrixExpression& a);
/// The product; with a 1 x 1 matrix that of a scalar.
MatrixExpression operator*(const MatrixExpression& a, const MatrixExpression& b);
MatrixExpression transpose(const MatrixExpression& a);
MatrixExpression inverse(const MatrixExpression& a);
/// e^a of a square matrix.
MatrixExpression exponential(const MatrixExpression& a);
/// He(a) = a + aᵀ
MatrixExpression He(const MatrixExpression& a);

/// A matrix of blocks, row by row.
MatrixExpression blocks(const std::vector<std::vector<MatrixExpression>>& rows);

/// A symmetric matrix of blocks, of which row i gives those from the diagonal on (the others are
/// the papers' bullets).
MatrixExpression symmetric_blocks(const std::vector<std::vector<MatrixExpression>>& rows);

}  // namespace sampled_data_observers
